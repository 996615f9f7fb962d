// Every cause → the right permit in the exact cycle.

#include "safety/conditions/common/frame_conditions.h"
#include "safety/monitor_fixture.h"
#include "support/allocation_guard.h"
#include "support/constants.h"
#include "support/measured_contacts.h"

namespace robot_control::tests {

struct CausesTest : MonitorTest {
  CausesTest() { drive(); }
  void expect_stop(SupervisorState state, StopCause cause) const {
    EXPECT_EQ(permit_.state, state);
    EXPECT_EQ(permit_.action, PermitAction::kBrake);
    EXPECT_EQ(permit_.causes, std::uint64_t{cause});
    EXPECT_EQ(permit_.active, std::uint64_t{cause});
    EXPECT_EQ(permit_.first_cause, std::uint64_t{cause});
    EXPECT_EQ(permit_.since_cycle, cycle());
  }
  void expect_driving() const {
    ASSERT_EQ(permit_.action, PermitAction::kDrive);
    ASSERT_EQ(permit_.causes, 0u);
  }
};

TEST_F(CausesTest, HealthyDrivingIsPermittedForFourCyclesAtATime) {
  for (int i = 0; i < 100; ++i) {
    ++input_.operator_input.heartbeats;
    steps(10);
  }
  expect_driving();
  EXPECT_EQ(permit_.expiry, cycle() + 4);
  EXPECT_EQ(permit_.driver_instance, 77u);
  EXPECT_EQ(permit_.ramp_until, 0u);
}

TEST_F(CausesTest, EmergencyStopThatCameAndWentBetweenTwoCyclesStops) {
  ++input_.operator_input.e_stop_triggers;
  step();
  expect_stop(SupervisorState::kStopped, kCauseEmergencyStopTopic);
  step();
  EXPECT_EQ(permit_.active, 0u);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseEmergencyStopTopic});
}

TEST_F(CausesTest, DriverFaultStateStopsForRepair) {
  sensors_.driver_state = DriverState::kFault;
  step();
  expect_stop(SupervisorState::kFault, kCauseDriverFault);
}

TEST_F(CausesTest, ACommandInTimeRestartsTheCount) {
  for (int i = 0; i < 5; ++i) {
    ++input_.operator_input.heartbeats;
    input_.command = nullptr;
    steps(kLoss - 1);
    input_.command = &command_;
    step();
  }
  expect_driving();
}

TEST_F(CausesTest, WhateverIsSaidToBeValidMustBeFinite) {
  sensors_.valid |= kValidBattery;
  measure_contacts(sensors_);
  sensors_.battery_voltage = 24;
  sensors_.contacts[0].force[2] = sensors_.contacts[1].force[2] = 6 * 9.81;
  const SensorFrame healthy = sensors_;
  double* const numbers[] = {&sensors_.joints[1].position,   &sensors_.joints[1].velocity,
                             &sensors_.joints[1].effort,     &sensors_.imu.angular_velocity[2],
                             &sensors_.contacts[1].force[0], &sensors_.battery_voltage,
                             &sensors_.battery_current,      &sensors_.imu.linear_acceleration[0]};
  EXPECT_TRUE(finite(sensors_));
  for (double* const number : numbers) {
    *number = kNaN;
    EXPECT_FALSE(finite(sensors_));
    sensors_ = healthy;
  }
}

TEST_F(CausesTest, ASensorThatIsNotValidMayHoldAnything) {
  sensors_.valid = 0;
  sensors_.imu.angular_velocity[1] = sensors_.imu.linear_acceleration[2] = kNaN;
  sensors_.joints[2].position = kNaN;  // the robot has two
  sensors_.contacts[0].force[1] = sensors_.battery_voltage = sensors_.battery_current = kNaN;
  steps(10);
  expect_driving();
}

TEST_F(CausesTest, ACommandThatIsNotFiniteStopsInTheThirdCycleInARow) {
  command_.joints[1].effort = std::numeric_limits<double>::infinity();
  steps(2);
  expect_driving();
  step();
  expect_stop(SupervisorState::kStopped, kCauseNotFinite);
}

TEST_F(CausesTest, ASilentDriverIsLost) {
  wait(SensorSilence::kTimedOut);
  expect_stop(SupervisorState::kStopped, kCauseDriverLost);
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.active, 0u);
}

TEST_F(CausesTest, ADriverThatWasNeverThereIsNotLost) {
  SafetyMonitor monitor(parameters(), robot(), kPeriod);
  monitor.step({.silence = SensorSilence::kTimedOut}, permit_);
  EXPECT_EQ(permit_.causes, 0u);
}

TEST_F(CausesTest, AStepWithoutAFrameCountsNoCycle) {
  input_.command = nullptr;
  steps(kLoss - 1);
  for (int i = 0; i < 10; ++i) wait();
  expect_driving();
}

TEST_F(CausesTest, CorruptSensorFramesInARowStopWithoutAnother) {
  wait(SensorSilence::kNone, FrameConditions::kPersistence - 1);
  expect_driving();
  wait(SensorSilence::kNone, FrameConditions::kPersistence);
  expect_stop(SupervisorState::kStopped, kCauseCorruptFrame);
}

// Category 1.

/// A heartbeat came every 10 cycles so far, the last one in this cycle.
struct HeartbeatTest : CausesTest {
  HeartbeatTest() {
    for (int i = 0; i < 10; ++i) {
      ++input_.operator_input.heartbeats;
      steps(i < 9 ? 10 : 1);
    }
  }
};

TEST_F(HeartbeatTest, KeepsDrivingThroughTheTimeout) {
  steps(kHeartbeat);
  expect_driving();
}

TEST_F(HeartbeatTest, ABeatDuringTheRampDoesNotSaveIt) {
  steps(kHeartbeat + 1);
  ++input_.operator_input.heartbeats;
  step();
  EXPECT_EQ(permit_.active, 0u);
  EXPECT_EQ(permit_.state, SupervisorState::kStopping);
}

TEST_F(HeartbeatTest, RampEndsAtStandstill) {
  steps(kHeartbeat + 1);
  turn_wheels(0);
  target(0);
  steps(kStands - 5);
  EXPECT_EQ(permit_.state, SupervisorState::kStopping);
  steps(5);
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

TEST_F(HeartbeatTest, ASevererCauseEndsTheRampAtOnce) {
  steps(kHeartbeat + 1);
  ++input_.operator_input.e_stop_services;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.action, PermitAction::kBrake);
  EXPECT_EQ(permit_.first_cause, std::uint64_t{kCauseHeartbeatLost});
  EXPECT_EQ(permit_.causes, kCauseHeartbeatLost | kCauseEmergencyStopService);
}

TEST_F(HeartbeatTest, AFaultEndsTheRampInFault) {
  steps(kHeartbeat + 1);
  sensors_.faults = kFaultLink;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kFault);
}

// The fixture has requested motion for a few cycles; no heartbeat was ever sent.
TEST_F(CausesTest, MotionWithoutAnyHeartbeatStopsAfterTheTimeout) {
  const std::uint64_t since = permit_.since_cycle;  // the first cycle of DRIVE; the next is the first after it
  while (cycle() < since + 1 + kHeartbeat) {
    step();
    expect_driving();
  }
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopping);
}

TEST_F(MonitorTest, AStandingRobotNeedsNoHeartbeat) {
  steps(10 * kHeartbeat);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

TEST_F(MonitorTest, AHeartbeatFromBeforeTheRunIsNone) {
  ++input_.operator_input.heartbeats;
  new_run();
  steps(2 * kHeartbeat);
  EXPECT_EQ(permit_.causes, 0u);
}

TEST_F(MonitorTest, HeartbeatTimeoutZeroAsksForNone) {
  SafetyParameters none = parameters();
  none.heartbeat_timeout = 0;
  monitor_ = SafetyMonitor(none, robot(), kPeriod);
  new_run();
  step();
  drive();
  steps(10 * kHeartbeat);
  EXPECT_EQ(permit_.state, SupervisorState::kDrive);
}

// First and all causes.

TEST_F(CausesTest, RemembersTheFirstCauseAndCollectsAll) {
  ++input_.operator_input.e_stop_services;
  step();
  input_.command = nullptr;
  steps(kLoss);
  input_.state = nullptr;
  steps(kLoss);
  EXPECT_EQ(permit_.first_cause, std::uint64_t{kCauseEmergencyStopService});
  EXPECT_EQ(permit_.causes, kCauseEmergencyStopService | kCauseControllerLost | kCauseEstimatorLost);
  EXPECT_EQ(permit_.active, std::uint64_t{kCauseEstimatorLost});
}

TEST_F(CausesTest, WithoutAStateTheControllerIsNotBlamed) {
  input_.command = nullptr;
  input_.state = nullptr;
  steps(kLoss);
  expect_stop(SupervisorState::kStopped, kCauseEstimatorLost);
}

TEST_F(CausesTest, CountsCyclesNotLooks) {
  input_.command = nullptr;
  const std::uint64_t gone = cycle();
  while (permit_.causes == 0) {
    sensors_.head.cycle += 4;  // the monitor wakes every fifth cycle
    step();
  }
  EXPECT_LT(cycle() - gone, kLoss + 5);
}

TEST_F(CausesTest, AMonitorThatMissedMoreThanLossCyclesStops) {
  sensors_.head.cycle += kLoss - 1;
  step();
  expect_driving();
  sensors_.head.cycle += kLoss;
  step();
  expect_stop(SupervisorState::kStopped, kCauseMonitorLate);
}

// The driver skipped the cycles, too: no node had them.
TEST_F(CausesTest, ALateLoopIsNamedBeforeTheNodesThatItKept) {
  input_.state = nullptr;
  input_.command = nullptr;
  sensors_.head.cycle += 2 * kLoss;
  step();
  expect_stop(SupervisorState::kStopped, kCauseMonitorLate);
}

// At half its rate the loop has the state of no cycle before.
TEST_F(CausesTest, ALoopAtHalfItsRateIsLateAndStopsAsSoon) {
  input_.state = nullptr;
  const std::uint64_t gone = cycle();
  while (permit_.causes == 0) {
    sensors_.head.cycle += 1;
    step();
  }
  EXPECT_LT(cycle() - gone, kLoss + 2);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseMonitorLate});
}

TEST_F(CausesTest, AFaultAfterAStopIsAFault) {
  ++input_.operator_input.e_stop_services;
  step();
  sensors_.faults = kFaultDrive;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kFault);
  EXPECT_EQ(permit_.first_cause, std::uint64_t{kCauseEmergencyStopService});
}

TEST_F(CausesTest, OfTwoCausesInOneCycleOneIsNamedFirst) {
  ++input_.operator_input.e_stop_services;
  sensors_.digital_inputs = kInputEmergencyStop;
  step();
  EXPECT_EQ(permit_.first_cause, std::uint64_t{kCauseEmergencyStopService});
}

// READY and DRIVE.

TEST_F(MonitorTest, ReadyPermitsAndBecomesDriveWithARequestOrAMotion) {
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
  EXPECT_EQ(permit_.action, PermitAction::kDrive);
  ask_for(1e-9);
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kDrive);
  ask_for(0);
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
  turn_wheels(-0.3);  // 10 mrad, twice the window of 0.05 rad/s · 0.1 s, take 33 ms, and a count more
  steps(30);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
  steps(40);  // twice as long where a new window began meanwhile
  EXPECT_EQ(permit_.state, SupervisorState::kDrive);
  turn_wheels(0.04);
  steps(kStands - 30);  // the last window began up to 20 cycles earlier
  EXPECT_EQ(permit_.state, SupervisorState::kDrive);
  steps(30);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

// The wheel rests at the edge of a count: 1.53 rad/s for a cycle, every now and then, is one count.
TEST_F(CausesTest, ACountOfAWheelAtRestIsNoMotion) {
  stand();
  for (int count = 0; count < 3; ++count) {
    turn_wheels(count % 2 == 0 ? 1.53 : -1.53);
    step();
    EXPECT_EQ(permit_.state, SupervisorState::kReady);
    turn_wheels(0);
    ++input_.operator_input.heartbeats;
    steps(kStands);
  }
  turn_wheels(1.53);
  steps(10);
  EXPECT_EQ(permit_.state, SupervisorState::kDrive);
}

TEST_F(CausesTest, ACasterThatTurnsIsNoMotion) {
  sensors_.joint_count = kWheels + 1;
  sensors_.joints[kWheels].velocity = 10;
  stand();
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

TEST_F(CausesTest, StepsWithoutAllocating) {
  if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer owns the allocator";
  AllocationGuard guard;
  steps(200);
  ++input_.operator_input.e_stop_services;
  step();
  request_reset();
  step();
  new_run();
  inherit({.permit = &permit_});
  step();
  wait(SensorSilence::kTimedOut);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(SafetyMonitorConstruction, RefusesParametersOutOfRange) {
  const auto refused = [](auto change, double period) {
    SafetyParameters parameters;
    change(parameters);
    EXPECT_THROW(SafetyMonitor(parameters, DriveTrain(), period), std::invalid_argument);
  };
  refused([](SafetyParameters&) {}, 0);
  refused([](SafetyParameters& p) { p.loss_cycles = 0; }, 1e-3);
  refused([](SafetyParameters& p) { p.heartbeat_timeout = -1; }, 1e-3);
  refused([](SafetyParameters& p) { p.ramp_time = kNaN; }, 1e-3);
  refused([](SafetyParameters& p) { p.standstill_speed = 0; }, 1e-3);
}

}  // namespace robot_control::tests
