// Compares a wheel with its target in cases beyond the table of conditions.

#include "safety/monitor_fixture.h"

namespace robot_control::tests {

struct WheelTargetTest : MonitorTest {
  WheelTargetTest() {
    SafetyParameters chosen = without_heartbeat();
    chosen.yaw_rate.reaction = Reaction::kOff;
    drive_with(chosen, robot());
  }
};

// The target goes from 5 rad/s to −5 rad/s at 10 rad/s², and the drive reaches 6 rad/s²: up to 4 rad/s against the
// target.
TEST_F(WheelTargetTest, AWeakDriveThatTurnsRoundIsNotWrong) {
  double wanted = kSpeed;
  double speed = kSpeed;
  while (speed > -kSpeed) {
    wanted = std::max(wanted - 10 * kPeriod, -kSpeed);
    speed -= 6 * kPeriod;
    target(wanted);
    turn_wheels(speed);
    step();
    ASSERT_EQ(permit_.causes, 0u) << speed;
  }
}

// It needs 0.2 s from 5 rad/s to the limit of 3.75 rad/s, and loses 0.18 rad/s within the persistence of 50 ms.
TEST_F(WheelTargetTest, AWheelThatSlowsDownAfterItsTargetJumpedIsNotWrong) {
  target(-kSpeed);
  for (double speed = kSpeed; speed > -kSpeed; speed -= 6 * kPeriod) {
    turn_wheels(speed);
    step();
    ASSERT_EQ(permit_.causes, 0u) << speed;
  }
}

TEST_F(WheelTargetTest, AWheelThatStaysBelowItsTargetButTurnsIsNotStalled) {
  turn_wheels(0.25 * kSpeed);
  steps(5000);
  EXPECT_EQ(permit_.causes, 0u);
}

// The left encoder is stuck, and its target passes 0: the gyro alone shows that the wheel turns.
TEST_F(WheelTargetTest, AWheelThatStandsThoughTheGyroShowsThatItTurnsIsStalledHoweverSlowItsTarget) {
  constexpr double kUnseen = 4;  // rad/s of yaw, beyond limit and tolerance
  target(0.01);
  turn_wheels(0);
  steps(100);
  EXPECT_EQ(permit_.causes, 0u);
  const double tolerance = 2 * kQuantum / kSpeedWindow * robot().wheels[0].radius / robot().effective_wheel_base();
  sensors_.imu.angular_velocity[2] = kUnseen + *parameters().yaw_rate.limit + tolerance;
  const double speed = kUnseen * robot().effective_wheel_base() / robot().wheels[0].radius;
  const auto cycles = static_cast<std::uint64_t>((kStall + kQuantum) / speed / kPeriod);
  steps(cycles - 2);
  EXPECT_EQ(permit_.causes, 0u);
  steps(4);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseStall});
}

/// 64 counts a turn give one in 0.49 s at 0.2 rad/s. The motors push all the time, as inside a skid steer's curve.
struct CoarseEncoderTest : WheelTargetTest {
  static constexpr double kSlow = 0.2;             // rad/s
  static constexpr double kCount = 64 * kQuantum;  // rad

  CoarseEncoderTest() {
    ask_for(0);
    turn_wheels(0);
    new_run();
    quantum_ = kCount;
    steps(kStart);
    drive();
    steps(100);
    target(kSlow);
    turn_wheels(kSlow);
    for (std::size_t i = 0; i < kWheels; ++i) sensors_.joints[i].effort = 0.6 * robot().joints[i].effort_limit;
  }
};

TEST_F(CoarseEncoderTest, AWheelThatTurnsFromCountToCountIsNotStalled) {
  steps(20000);
  EXPECT_EQ(permit_.causes, 0u);
}

// The next count may be a whole one away, and the last one leaves the window late. Then kStall, with a quantum, passes
// at kPushedSpeed.
TEST_F(CoarseEncoderTest, AWheelThatStandsIsStalledOnceItsCountIsOverdue) {
  const double owed = kCount / kSlow, missed = (kStall + kCount) / Stall::kPushedSpeed;
  steps(static_cast<std::uint64_t>(owed / kPeriod));
  turn_wheels(0);
  steps(static_cast<std::uint64_t>(missed / kPeriod) - 1);
  EXPECT_EQ(permit_.causes, 0u);
  steps(static_cast<std::uint64_t>((owed + kSpeedWindow) / kPeriod) + 1);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseStall});
}

// At 30 rad/s the 0.3 rad of kStall take 10 cycles; corrupt_frame, the true cause, takes 3.
TEST_F(WheelTargetTest, AnAbsurdTargetDoesNotMakeAStallOfOneCycle) {
  DriveTrain limited = robot();
  for (std::size_t i = 0; i < kWheels; ++i) limited.joints[i].velocity_limit = 30;
  monitor_ = SafetyMonitor(parameters(), limited, kPeriod);
  new_run();
  steps(kStart);
  target(1e6);
  turn_wheels(0);
  steps(3);
  EXPECT_EQ(permit_.causes & kCauseStall, 0u);
}

TEST_F(WheelTargetTest, WhatTheGateDidNotPassIsNotCompared) {
  gate_works_ = false;
  target(-kSpeed);
  steps(kLoss);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseGateRefuses});
}

TEST_F(WheelTargetTest, ARobotThatSwingsAboutItsRestDoesNotStop) {
  target(0);
  for (int i = 0; i < 3500; ++i) {
    turn_wheels(0.3 * std::cos(10.0 * i * kPeriod));  // ±30 mrad
    step();
  }
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseNotStopping});
}

TEST_F(WheelTargetTest, ARobotWithoutEncodersIsNotSaidToMove) {
  target(0);
  turn_wheels(0);
  set_joints_valid(sensors_, 0);
  steps(5000);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseEncodersLost});
}

TEST_F(WheelTargetTest, ACommandIsStaleAsLateInANewRun) {
  ask_for(0);
  turn_wheels(0);
  fresh_state_ = false;
  new_run();
  steps(kLoss - 1);
  EXPECT_EQ(permit_.causes, 0u);
  step();
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseCommandStale});
}

TEST_F(WheelTargetTest, ACommandIsNotStaleForWantOfAState) {
  fresh_state_ = false;
  input_.state = nullptr;
  steps(kLoss);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseEstimatorLost});
}

/// Two axles, of which the fixture has one wheel each: in a turn on the spot either scrubs with `kScrub`.
struct ScrubbingTest : WheelTargetTest {
  static constexpr double kScrub = 0.1 * 6 * 9.81 * 0.6247;  ///< N·m: 12 kg, friction 1 (scrub_test.cpp)

  ScrubbingTest() {
    DriveTrain scrubbing = robot();
    scrubbing.wheels[0].centre_base[0] = 0.2;
    scrubbing.wheels[1].centre_base[0] = -0.2;
    scrubbing.wheel_base_multiplier = 1.64;
    for (JointModel& joint : scrubbing.joints) joint.effort_limit = 30;
    SafetyParameters chosen = derived_limits(parameters(), scrubbing, 15);
    chosen.yaw_rate.reaction = Reaction::kOff;
    chosen.heartbeat_timeout = 0;
    drive_with(chosen, scrubbing);
  }

  /// Turns on the spot with kSpeed; the wheels turn with `speed` and have `torque`, both towards their targets.
  void turn(double speed, double torque) {
    target(kSpeed);
    command_.joints[0].velocity = -kSpeed;
    speed_ = {-speed, speed};
    sensors_.joints[0].effort = -torque;
    sensors_.joints[1].effort = torque;
  }
};

// The report is at most half as late again as any other.
TEST_F(ScrubbingTest, WheelsWhoseTorqueIsBelowTheirFrictionAndGrowsAreStalledLater) {
  const double usual = kStall / kSpeed;
  int k = 0;
  for (; permit_.causes == 0 && k < 2000; ++k) {
    turn(0, (-1 + 3.9 * k / 1500) * kScrub);  // the reversal of a weak loop
    step();
  }
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseStall});
  EXPECT_GT(k * kPeriod, (1 + Stall::kMaxExcusedShare) * usual);
  EXPECT_LT(k * kPeriod, (1 + Stall::kMaxExcusedShare) * usual + kSpeedWindow);
}

}  // namespace robot_control::tests
