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
      damage();
      loop.monitor->step();
    }
  }

  virtual void damage() {}

  void e_stop() { loop.monitor->inbox().store({.e_stop_services = ++stops_}); }
  std::uint64_t causes() const { return loop.newest_permit().causes; }

  Loop loop;
  std::uint64_t stops_ = 0;
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

TEST_F(BlindMonitor, LatchesWhenTheHeadAnnouncesAnotherRobot) {
  cycles(3);
  loop.sensors.memory->head.robot_hash.store(0);
  cycles(kLoss + 1);
  EXPECT_EQ(causes(), std::uint64_t{kCauseDriverLost});
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

TEST_F(BlindMonitor, LatchesAnEmergencyStopWhileItIsBlind) {
  loop.sensors.memory->head.robot_hash.store(0);
  cycles(kLoss + 1);
  e_stop();
  clock_ns += kPeriodNs;
  loop.monitor->step();
  EXPECT_NE(causes() & kCauseEmergencyStopService, 0u);
}

TEST_F(BlindMonitor, IsNotBlindToADriverThatIsPaused) {
  cycles(3);
  for (std::uint64_t i = 0; i < 10 * kLoss; ++i) {
    clock_ns += 100 * kPeriodNs;
    loop.driver.publish_paused();
    loop.monitor->step();
    loop.monitor->time_out();
  }
  EXPECT_EQ(causes(), 0u);
}

TEST_F(BlindMonitor, ADriverThatEndedIsMissingAndNotLost) {
  cycles(3);
  loop.driver.publish_ended();
  loop.monitor->step();
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kInit);
  EXPECT_EQ(loop.newest_permit().action, PermitAction::kBrake);
  EXPECT_NE(loop.newest_permit().missing & kMissingSensors, 0u);
  clock_ns += 1000 * kPeriodNs;
  loop.monitor->time_out();
  EXPECT_EQ(causes(), 0u);
}

TEST_F(BlindMonitor, ADriverThatEndedAndIsStartedAgainIsLost) {
  loop.driver.publish_ended();
  loop.monitor->step();
  loop.driver.set_driver_instance(100);
  loop.driver.begin_run(2);
  cycles(3);
  EXPECT_EQ(causes(), std::uint64_t{kCauseDriverLost});
}

// Before the first sensor frame.

struct MonitorWithoutDriver : BlindMonitor {
  MonitorWithoutDriver() {
    static_cast<TestChannels&>(loop) = {};
    loop.monitor = make_monitor();
  }
};

TEST_F(MonitorWithoutDriver, LatchesAnEmergencyStop) {
  e_stop();
  loop.monitor->idle();
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped);
  EXPECT_EQ(causes(), std::uint64_t{kCauseEmergencyStopService});
}

TEST_F(MonitorWithoutDriver, AnEmergencyStopOutlivesTheMonitor) {
  e_stop();
  loop.monitor->idle();
  loop.monitor = make_monitor();
  EXPECT_EQ(loop.monitor->permit().causes, std::uint64_t{kCauseEmergencyStopService});
}

TEST_F(MonitorWithoutDriver, RefusesAReset) {
  e_stop();
  loop.monitor->idle();
  loop.monitor->inbox().store({.e_stop_services = stops_, .resets = 1});
  loop.monitor->idle();
  EXPECT_EQ(loop.newest_permit().resets_handled, 1u);
  EXPECT_NE(loop.newest_permit().reset_refusal, 0u);
  EXPECT_EQ(causes(), std::uint64_t{kCauseEmergencyStopService});
}

// A latch outlives its processes.

struct LatchedLoop : BlindMonitor {
  LatchedLoop() {
    e_stop();
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

TEST_F(LatchedLoop, StaysLatchedWhenDriverAndMonitorAreRestarted) {
  restart_driver_and_monitor();
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped);
  EXPECT_EQ(causes(), std::uint64_t{kCauseEmergencyStopService});
}

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

TEST_F(LatchedLoop, IsLatchedWhereNoPermitIsWhole) {
  for (auto& slot : loop.permit.memory->slots) slot.words[20].fetch_xor(1);
  restart_driver_and_monitor();
  EXPECT_NE(causes() & kCauseLatchUnreadable, 0u);
}

}  // namespace robot_control::tests
