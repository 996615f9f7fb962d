// Wall clock: a monitor without a current sensor frame latches for any reason, and receives the operator's input all
// the time.

#include <gtest/gtest.h>

#include "cycle_fixture.h"

namespace robot_control::tests {

std::int64_t clock_ns = 0;  // of these tests
std::int64_t virtual_clock() {
  return clock_ns;
}

/// A loop in READY whose monitor has a clock; one period passes in each cycle.
struct BlindMonitor : ::testing::Test {
  static constexpr std::uint64_t kLoss = 20;

  BlindMonitor() {
    clock_ns = 1'000'000'000;
    loop.monitor = make_monitor();
    loop.steps(5);
    EXPECT_EQ(loop.newest_permit().state, SupervisorState::kReady);
  }

  std::unique_ptr<MonitorCycle> make_monitor() {
    return std::make_unique<MonitorCycle>(
        std::make_unique<MonitorOf<SafetyMonitor>>(SafetyParameters{}, loop.robot, kPeriod), loop.robot.hash, kLossNs,
        loop.of_monitor(), CommandScript(), virtual_clock);
  }

  /// The driver publishes and wakes the monitor in every period.
  void cycles(std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      clock_ns += kPeriodNs;
      loop.step();
      loop.monitor->step();
    }
  }

  std::uint64_t causes() const { return loop.newest_permit().causes; }

  Loop loop;
};

TEST_F(BlindMonitor, LatchesWhenTheHeadAnnouncesAnotherRun) {
  cycles(3);
  loop.sensors.memory->head.attached_run.store(12345);
  cycles(kLoss - 1);
  EXPECT_EQ(causes(), 0u);
  cycles(2);
  EXPECT_EQ(causes(), std::uint64_t{kCauseDriverLost});
  EXPECT_EQ(loop.newest_permit().action, PermitAction::kBrake);
}

TEST_F(BlindMonitor, LatchesWhenTheNewestSlotIsNone) {
  cycles(3);
  for (std::uint64_t i = 0; i <= kLoss; ++i) {
    clock_ns += kPeriodNs;
    loop.sensors.memory->newest.store(99);
    loop.monitor->step();
  }
  EXPECT_EQ(causes(), std::uint64_t{kCauseDriverLost});
}

// A latch outlives its processes.

struct LatchedLoop : BlindMonitor {
  LatchedLoop() {
    loop.monitor->inbox().store({.e_stop_services = 1});
    cycles(3);
    EXPECT_EQ(causes(), std::uint64_t{kCauseEmergencyStopService});
  }

  void restart_driver_and_monitor() {
    loop.driver.set_driver_instance(100);
    loop.driver.begin_run(2);
    loop.monitor = make_monitor();
    cycles(5);
  }
};

TEST_F(LatchedLoop, StaysLatchedWhenTheMonitorDiedWhileItWrote) {
  auto& memory = *loop.permit.memory;
  memory.slots[memory.newest.load() - 1].version.fetch_add(1);
  restart_driver_and_monitor();
  EXPECT_NE(causes() & kCauseEmergencyStopService, 0u);
}

TEST_F(LatchedLoop, StaysLatchedBehindATokenOfAFaultyMonitor) {
  set_fault(loop.machine.faults, {.component = FaultComponent::kMonitor, .kind = FaultKind::kOff});
  cycles(3);
  loop.machine.faults = {};
  restart_driver_and_monitor();
  EXPECT_NE(causes() & kCauseEmergencyStopService, 0u);
}

}  // namespace robot_control::tests
