#include "loop/processes/loop_hold.h"

#include <gtest/gtest.h>

#include <thread>

#include "support/allocation_guard.h"

namespace robot_control::tests {

constexpr std::int64_t kMillisecond = 1'000'000;   // ns
constexpr std::int64_t kTimeout = 10'000'000'000;  // ns; never reached where the loop answers

TEST(LoopHold, TicksWhenNothingIsAsked) {
  LoopHold hold;
  EXPECT_TRUE(hold.may_tick(0));
  EXPECT_TRUE(hold.may_tick(1'000'000));
}

TEST(LoopHold, StandsWhilePausedAndTicksAfterwards) {
  LoopHold hold;
  hold.request({.paused = 1});
  EXPECT_FALSE(hold.may_tick(7));
  hold.request({.paused = 0});
  EXPECT_TRUE(hold.may_tick(7));
}

TEST(LoopHold, PausedItTicksUpToTheCycleAskedForAndNoFurther) {
  LoopHold hold;
  hold.request({.paused = 1, .step_until = 10});
  EXPECT_TRUE(hold.may_tick(9));
  EXPECT_FALSE(hold.may_tick(10));
}

TEST(LoopHold, AParkedLoopDoesNotTickWhateverElseIsAsked) {
  LoopHold hold;
  hold.request({.paused = 1, .step_until = 10, .parked = 1});
  EXPECT_FALSE(hold.may_tick(9));
  EXPECT_TRUE(hold.park_requested());
}

TEST(LoopHold, AnswersWithTheAskingUnderWhichItStands) {
  LoopHold hold;
  const std::atomic<bool> stopping{false};
  const std::uint64_t first = hold.request({.paused = 1});
  EXPECT_FALSE(hold.stands(first)) << "no cycle has looked";
  ASSERT_FALSE(hold.may_tick(3));
  hold.stand(kMillisecond, stopping);
  EXPECT_TRUE(hold.stands(first));
  EXPECT_EQ(hold.next_cycle(), 3u);
  EXPECT_FALSE(hold.stands(hold.request({.paused = 1, .step_until = 5})));
}

TEST(LoopHold, AwaitsNothingWhereNoLoopRuns) {
  LoopHold hold;
  EXPECT_FALSE(hold.await_stand(hold.request({.paused = 1}), kTimeout));
}

TEST(LoopHold, HandsTheFaultsOver) {
  LoopHold hold;
  InjectedFaults faults{};
  faults[0] = {FaultComponent::kEncoder, 1, FaultKind::kStuck};
  hold.request({.faults = faults});
  ASSERT_TRUE(hold.may_tick(0));
  EXPECT_EQ(hold.faults(), faults);
}

/// The parked loop's thread does not touch `guarded`, although its wait ends again and again.
TEST(LoopHold, AParkedLoopLeavesTheMachineToItsHolder) {
  LoopHold hold;
  std::atomic<bool> stopping{false};
  std::uint64_t guarded = 0;  // not atomic: a race is the thread sanitizer's to find
  std::thread loop([&] {
    hold.begin();
    for (std::uint64_t cycle = 0; !stopping.load(); ++cycle) {
      while (!hold.may_tick(cycle) && !stopping.load()) hold.stand(kMillisecond, stopping);
      if (!stopping.load()) ++guarded;
    }
    hold.end();
  });
  while (!hold.looping()) std::this_thread::yield();
  for (int round = 0; round < 100; ++round) {
    ASSERT_TRUE(hold.await_stand(hold.request({.parked = 1}), kTimeout));
    guarded = 0;
    hold.request({.paused = 1, .parked = 1});
    EXPECT_EQ(guarded, 0u);
    hold.request({});
  }
  stopping.store(true);
  hold.request({});
  loop.join();
}

TEST(LoopHold, TheLoopsSideDoesNotAllocate) {
  LoopHold hold;
  const std::atomic<bool> stopping{false};
  hold.request({.paused = 1});
  const AllocationGuard guard;
  hold.begin();
  if (!hold.may_tick(0)) hold.stand(kMillisecond, stopping);
  hold.park_requested();
  hold.end();
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control::tests
