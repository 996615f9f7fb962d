/// Another program takes the chain's core, in real time.

#include "hog.h"

#include "losses_fixture.h"

namespace robot_control::tests {

struct AHog : Losses {
  static Parameters on_one_core() {
    Parameters parameters = DrivingRobot::quick(kParams);
    parameters.loop.core = 0;
    return parameters;
  }
  AHog() : Losses(on_one_core()) {}

  void SetUp() override {
    if (off_.problem != nullptr) GTEST_SKIP() << off_.problem;
  }

  OffTheChain off_;
};

TEST_F(AHog, StarvesTheControllerAtItsPriorityAndTheRobotBrakes) {
  Hog hog(static_cast<int>(LoopPriority::kController), 0);
  robot_.poll();
  log().forget();
  const std::uint64_t before = robot_.cycle();
  hog.begin();
  EXPECT_TRUE(robot_.await([&] { return log().rested(DrivingRobot::kRestCycles); }, kHogSeconds / 2))
      << robot_.situation();
  hog.end();
  const std::uint64_t braked = log().braking_since().value_or(before + 1000);
  std::printf("  brake after %llu cycles\n", static_cast<unsigned long long>(braked - before));
  EXPECT_LE(braked, before + kBrakeWithin);
  expect_latched_until_reset_and_new_command(kCauseControllerLost);
}

/// Nothing of this software runs then. In the simulation the world stands still, too. On a machine it does not, and
/// only the drives' own watchdogs brake.
TEST_F(AHog, AboveTheDriverStopsEverythingAndAfterItNothingJumps) {
  constexpr std::int64_t kSpell = 300'000'000;  // ns; less than what the kernel's real-time throttling lets pass
  Hog hog(static_cast<int>(LoopPriority::kDriver) + 1, 0);
  robot_.poll();
  log().forget();
  hog.begin();
  sleep_ns(kSpell / 3);
  const std::uint64_t during = robot_.cycle();
  sleep_ns(kSpell / 3);
  EXPECT_EQ(robot_.cycle(), during) << "not one cycle: no software brakes";
  hog.end();
  EXPECT_TRUE(robot_.await([&] { return log().last().cycle > during + 200; })) << robot_.situation();
  expect_no_jump();
  for (const LoopNode node : kLoop) expect_lives(node);
  robot_.drive_at_full_speed();
  expect_undisturbed();
}

}  // namespace robot_control::tests
