// Conditions of wheels by themselves. An encoder counts once per cycle, so that its quantum is what a wheel turns in
// one.

#include "safety/conditions/wheeled/wheeled_conditions.h"

#include "safety/monitor_fixture.h"

namespace robot_control::tests {

constexpr double kPeriod = 1e-3;

/// rad/s, quantum/T (wheel_motion.h) at `speed`.
double tolerance(double speed) {
  return speed * kPeriod / 0.02;
}

struct WheeledConditionsTest : testing::Test {
  WheeledConditionsTest() {
    set_joints_valid(sensors_, kValidMotion);
    sensors_.valid = kValidGyro;
  }

  /// Turns every wheel of `robot` with its speed for 0.2 s; returns the measurement of `cause`, if it is active.
  std::optional<ConditionMeasurement> measured(const DriveTrain& robot, const SafetyParameters& parameters,
                                               const std::vector<double>& speeds, StopCause cause) {
    WheeledConditions conditions(derived_limits(parameters, robot, 15), robot, kPeriod);
    sensors_.joint_count = speeds.size();
    run(conditions, speeds);
    for (const auto& measurement : out_.measurements()) {
      if (measurement.cause == cause) return ConditionMeasurement{true, measurement.value, measurement.limit};
    }
    return std::nullopt;
  }
  void run(WheeledConditions& conditions, const std::vector<double>& speeds) {
    for (int k = 0; k < 200; ++k) {
      ++sensors_.head.cycle;
      for (std::size_t i = 0; i < speeds.size(); ++i) sensors_.joints[i].position += speeds[i] * kPeriod;
      out_.clear();
      conditions.step({.sensors = &sensors_}, 1, kNoSpeedLimit, out_);
    }
  }

  SensorFrame sensors_;
  ActiveCauses out_;
};

TEST_F(WheeledConditionsTest, InANewRunTheRobotNeitherStandsNorMoves) {
  const DriveTrain robot = two_wheels();
  WheeledConditions conditions(derived_limits({}, robot, 15), robot, kPeriod);
  sensors_.joint_count = 2;
  run(conditions, {0, 0});
  ASSERT_TRUE(conditions.standing());
  conditions.enter_run();
  EXPECT_FALSE(conditions.standing());
  EXPECT_FALSE(conditions.moving());
}

TEST_F(WheeledConditionsTest, ATargetOfAnEarlierRunIsNone) {
  const DriveTrain robot = two_wheels();
  WheeledConditions conditions(derived_limits({}, robot, 15), robot, kPeriod);
  sensors_.joint_count = 2;
  sensors_.gate.verdict = GateVerdict::kPassed;
  CommandFrame command;
  command.joint_count = 2;
  for (JointCommand& joint : command.joints) joint = {.mode = JointMode::kEffort, .velocity = -5};
  conditions.step({.sensors = &sensors_, .command = &command}, 1, kNoSpeedLimit, out_);
  conditions.enter_run();
  run(conditions, {5, 5});
  EXPECT_TRUE(out_.measurements().empty());
}

// 15 N·m · 5 rad/s; the other wheel brakes and draws nothing.
TEST_F(WheeledConditionsTest, PowerIsThatWhichTheMotorsDraw) {
  SafetyParameters parameters;
  parameters.power = {.limit = 60, .persistence = 0, .reaction = Reaction::kBrake};
  sensors_.joints[0].effort = -15;
  sensors_.joints[1].effort = 15;
  const auto power = measured(two_wheels(), parameters, {5, 5}, kCausePower);
  ASSERT_TRUE(power.has_value());
  EXPECT_NEAR(power->value, 75, 1e-6);
  EXPECT_NEAR(power->limit, 60 + (15 + 15) * tolerance(5), 1e-6);
}

TEST(SpeedLimitInForce, HoldsAfterTwoRampTimesOfItsRun) {
  SpeedLimitInForce limit(10 * kPeriod, kPeriod);
  limit.step(1, 5);
  limit.enter_run();
  for (int k = 1; k < 20; ++k) EXPECT_EQ(limit.step(1, 1), kNoSpeedLimit) << k;
  EXPECT_EQ(limit.step(1, 1), 1);
}

TEST_F(WheeledConditionsTest, WithoutAGyroNoYawRateIsCompared) {
  SafetyParameters parameters;
  parameters.yaw_rate = {.limit = 1, .persistence = 0, .reaction = Reaction::kBrake};
  sensors_.valid = 0;
  EXPECT_FALSE(measured(two_wheels(), parameters, {0, 10}, kCauseYawRate).has_value());
}

// The right wheel slows down by 10 rad/s within 20 ms, the left one speeds up by 5.
TEST_F(WheeledConditionsTest, TheWheelWhoseSpeedChangesMostIsNamed) {
  SafetyParameters parameters;
  parameters.wheel_acceleration = {.limit = 100, .persistence = 0, .reaction = Reaction::kBrake};
  const DriveTrain robot = two_wheels();
  WheeledConditions conditions(derived_limits(parameters, robot, 15), robot, kPeriod);
  sensors_.joint_count = 2;
  run(conditions, {1, 1});
  std::uint64_t named = kMaxJoints;
  for (int k = 1; k <= 20; ++k) {
    ++sensors_.head.cycle;
    sensors_.joints[0].position += (1 + 5 * k / 20.0) * kPeriod;
    sensors_.joints[1].position += (1 - 10 * k / 20.0) * kPeriod;
    out_.clear();
    conditions.step({.sensors = &sensors_}, 1, kNoSpeedLimit, out_);
    for (const auto& measurement : out_.measurements())
      if (measurement.cause == kCauseWheelAcceleration) named = measurement.joint;
  }
  EXPECT_EQ(named, 1u);
}

// The IMU is turned, and the vertical of the base is (−0.36, 0.8, 0.48) in its axes. The base turns by −0.1 rad/s about
// it, and by 0.88 rad/s across it.
TEST_F(WheeledConditionsTest, TheYawRateIsThatAboutTheVerticalOfTheBase) {
  SafetyParameters parameters;
  parameters.yaw_rate = {.limit = 1, .persistence = 0, .reaction = Reaction::kBrake};
  DriveTrain robot = two_wheels();
  robot.imu_in_base.orientation = {0.1, 0.5, 0.7, 0.5};
  sensors_.imu.angular_velocity = {0.036 + 0.8, -0.08 + 0.36, -0.048};
  const auto yaw = measured(robot, parameters, {0, 10}, kCauseYawRate);
  ASSERT_TRUE(yaw.has_value());
  EXPECT_NEAR(yaw->value, 2.1, 1e-6);
}

TEST_F(WheeledConditionsTest, TheTorqueOfAJointThatIsNoWheelIsNotEvaluated) {
  SafetyParameters parameters;
  parameters.wheel_effort = {.limit = 1, .persistence = 0, .reaction = Reaction::kBrake};
  sensors_.gate.verdict = GateVerdict::kPassed;
  sensors_.joints[2].effort = 100;
  EXPECT_FALSE(measured(two_wheels(), parameters, {1, 1}, kCauseWheelEffort).has_value());
  sensors_.joints[1].effort = -1.1 * two_wheels().joints[1].effort_limit;
  EXPECT_TRUE(measured(two_wheels(), parameters, {1, 1}, kCauseWheelEffort).has_value());
}

// The left side stands and the right one rolls at 1 m/s: 2 rad/s by a wheel base of 0.5 m. The gyro measures −0.1
// rad/s.
TEST_F(WheeledConditionsTest, SeveralWheelsOnOneSideScrub) {
  SafetyParameters parameters;
  parameters.yaw_rate = {.limit = 1, .persistence = 0, .reaction = Reaction::kBrake};
  sensors_.imu.angular_velocity[2] = -0.1;
  const auto alone = measured(two_wheels(), parameters, {0, 10}, kCauseYawRate);
  ASSERT_TRUE(alone.has_value());
  EXPECT_NEAR(alone->value, 2.1, 1e-6);
  EXPECT_NEAR(alone->limit, 1 + tolerance(10) * 0.1 / 0.5, 1e-6);
  for (const Side side : {Side::kLeft, Side::kRight}) {
    DriveTrain robot = two_wheels();
    robot.joints.push_back(robot.joints[0]);
    robot.wheels.push_back(robot.wheels[side == Side::kLeft ? 0 : 1]);
    robot.wheels[2].joint = 2;
    sensors_.joints = SensorFrame{}.joints;
    set_joints_valid(sensors_, kValidMotion);
    const auto several = measured(robot, parameters, {0, 10, side == Side::kLeft ? 0.0 : 10.0}, kCauseYawRate);
    ASSERT_TRUE(several.has_value());
    EXPECT_NEAR(several->value, 2.1, 1e-6);
    EXPECT_NEAR(several->limit, 1 + 0.5 * 2 + tolerance(10) * 0.1 / 0.5, 1e-6);
  }
}

}  // namespace robot_control::tests
