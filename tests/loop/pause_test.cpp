/// A simulated machine is paused, or reset, and the other nodes react.

#include <gtest/gtest.h>

#include "cycle_fixture.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

/// A loop in DRIVE with a standing command.
struct PausedLoop : ::testing::Test {
  PausedLoop() { loop.drive(); }

  /// The other nodes wake as often as the paused frame is published.
  void pause(int times = 1) {
    for (int i = 0; i < times; ++i) {
      loop.driver.publish_paused();
      EXPECT_FALSE(loop.estimator->step());
      EXPECT_FALSE(loop.controller->step());
      monitor_rows += loop.monitor->step() ? 1 : 0;
    }
  }

  Loop loop;
  int monitor_rows = 0;  ///< in pauses
};

TEST_F(PausedLoop, ShowsTheLastFrameAgain) {
  const SensorFrame before = loop.sensors.newest();
  pause();
  SensorFrame paused = loop.sensors.newest();
  EXPECT_EQ(paused.driver_state, DriverState::kPaused);
  paused.driver_state = before.driver_state;
  seal(paused);
  EXPECT_EQ(paused.head.checksum, before.head.checksum) << "and nothing else has changed";
}

TEST_F(PausedLoop, IsIgnoredByEveryNode) {
  const StateFrame state = loop.newest_state();
  const CommandFrame command = loop.newest_command();
  const Permit permit = loop.newest_permit();
  pause(50);
  EXPECT_EQ(loop.newest_state().head.checksum, state.head.checksum);
  EXPECT_EQ(loop.newest_command().head.checksum, command.head.checksum);
  EXPECT_EQ(loop.newest_permit().head.checksum, permit.head.checksum);
  EXPECT_EQ(monitor_rows, 0);
}

TEST_F(PausedLoop, GoesOnAsIfNothingHadBeen) {
  pause(50);
  loop.step();
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kPassed);
  EXPECT_EQ(loop.gate().held, 0u);
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kDrive);
}

TEST_F(PausedLoop, IsTakenForAFrameByAMonitorThatHasNotSeenItsCycle) {
  loop.driver.step();
  loop.driver.publish_paused();
  EXPECT_TRUE(loop.estimator->step());
  EXPECT_TRUE(loop.controller->step());
  EXPECT_TRUE(loop.monitor->step());
  loop.monitor->time_out();
  loop.steps(5);
  EXPECT_EQ(loop.newest_permit().causes, 0u);
  EXPECT_EQ(loop.gate().missed, 0u);
}

TEST_F(PausedLoop, ANewRunCarriesOnItsStampsAndTheirDistanceFromTheClock) {
  constexpr std::int64_t kSlipped = 3 * kPeriodNs;
  loop.driver.count_slip(kSlipped);
  loop.step();
  const SensorFrame last = loop.sensors.newest();
  loop.driver.set_start(loop.driver.next_stamp_ns());
  loop.driver.begin_run(2);
  const std::int64_t deadline = due_ns(last) + 50 * kPeriodNs;
  loop.driver.set_due(deadline);
  loop.step();
  const SensorFrame first = loop.sensors.newest();
  EXPECT_EQ(first.head.cycle, 0u);
  EXPECT_EQ(first.head.stamp_ns, last.head.stamp_ns + kPeriodNs);
  EXPECT_EQ(first.slipped_ns, 0u);
  EXPECT_EQ(due_ns(first), deadline);
}

TEST_F(PausedLoop, DoesNotAllocate) {
  const AllocationGuard guard;
  loop.driver.publish_paused();
  loop.monitor->step();
  loop.driver.inject({});
  loop.driver.set_due(loop.driver.next_stamp_ns());
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control::tests
