// Checks what the estimator learns about its wheels, and how it uses that.

#include "estimation/wheeled/estimator_fixture.h"
#include "estimation/wheeled/estimator_setup.h"
#include "machine/bodies/rigid_bodies.h"
#include "support/constants.h"

namespace robot_control::tests {

EstimatorParameters held() {
  EstimatorParameters parameters;
  parameters.self_calibration = false;
  return parameters;
}

/// The wheels have 0.4 % opposite radius error on a base that is 1.5 % wider than described; the drive turns either way
/// for five minutes.
struct EstimatorCalibrationTest : EstimatorFixture {
  explicit EstimatorCalibrationTest(const EstimatorParameters& parameters = {})
      : EstimatorFixture(two_wheeler(), parameters) {
    robot_.radius_ratio = 0.004;
    robot_.wheel_base = 0.015;
    stand(10000);
  }
  void practise(int seconds) {
    for (int i = 0; i < seconds * 1000; ++i) drive(0.5, 0.8 * std::sin(i * 4e-4), 1);
  }
};

struct EstimatorHeldCalibrationTest : EstimatorCalibrationTest {
  EstimatorHeldCalibrationTest() : EstimatorCalibrationTest(held()) {}
};

// The result is within three of its own deviations, which shrank to a fraction of the prior.
TEST_F(EstimatorCalibrationTest, RecoversRatioAndBase) {
  practise(120);
  EXPECT_NEAR(state_.wheeled.calibration.radius_ratio - 1, 0.004,
              3 * state_.wheeled.calibration.radius_ratio_deviation);
  EXPECT_NEAR(state_.wheeled.calibration.wheel_base_factor - 1, 0.015,
              3 * state_.wheeled.calibration.wheel_base_deviation);
  EXPECT_LT(state_.wheeled.calibration.radius_ratio_deviation, 0.001);
  EXPECT_LT(state_.wheeled.calibration.wheel_base_deviation, 0.005);
  EXPECT_EQ(state_.wheeled.slip, 0u);
}

TEST_F(EstimatorHeldCalibrationTest, HoldsWhatItStartedWith) {
  practise(30);
  EXPECT_EQ(state_.wheeled.calibration.radius_ratio, 1);
  EXPECT_EQ(state_.wheeled.calibration.wheel_base_factor, 1);
  EXPECT_EQ(state_.wheeled.calibration.radius_ratio_deviation, 0);
  EXPECT_EQ(state_.wheeled.calibration.wheel_base_deviation, 0);
}

TEST_F(EstimatorCalibrationTest, WhatARestartHoldsIsNotLearned) {
  practise(30);
  StateFrame last = state_;
  last.head.cycle = robot_.frame().head.cycle;
  ASSERT_GT(last.wheeled.calibration.radius_ratio_deviation, 0);
  estimator_ = Estimator(held(), two_wheeler(), kPeriod);
  estimator_.resume(last);
  practise(10);
  EXPECT_EQ(state_.wheeled.calibration.radius_ratio, last.wheeled.calibration.radius_ratio);
  EXPECT_EQ(state_.wheeled.calibration.wheel_base_factor, last.wheeled.calibration.wheel_base_factor);
  EXPECT_EQ(state_.wheeled.calibration.radius_ratio_deviation, 0);
}

// On a straight way the wheel base is not observable; noise of the gyro, in rate and innovation, must not change it.
TEST(EstimatorCalibration, TheWheelBaseStaysWhereNothingTurns) {
  RollingRobot robot;
  robot.noise = {.gyro = 2.44e-4, .accelerometer = 1.7e-3, .counts = 4096};
  Estimator estimator(rigid_tyres(), two_wheeler(), kPeriod);
  StateFrame state;
  for (int i = 0; i < 3000 + 60000; ++i) {
    robot.drive(i < 3000 ? 0 : 0.5, 0);
    estimator.step(robot.frame(), state);
  }
  EXPECT_NEAR(state.wheeled.calibration.wheel_base_factor, 1, 0.003);
  EXPECT_GT(state.wheeled.calibration.wheel_base_deviation, 0.02);
}

TEST(EstimatorCalibration, ATurnDragsWheelsBehindEachOther) {
  DriveTrain robot = two_wheeler();
  EXPECT_TRUE(drags_wheels(robot)) << "there may be other wheels";
  robot.bodies = std::make_shared<RigidBodies>();
  EXPECT_FALSE(drags_wheels(robot));
  robot.wheels[0].centre_base[0] = 1e-16;  // as a long chain of joints rounds it
  EXPECT_FALSE(drags_wheels(robot));
  robot.wheel_base_multiplier = 1.5;
  EXPECT_TRUE(drags_wheels(robot));
}

TEST(EstimatorCalibration, StartsWithWhatIsGiven) {
  EstimatorParameters parameters;
  parameters.calibration = {
      .radius_ratio = 1.004, .wheel_base_factor = 1.015, .radius_ratio_deviation = 1e-4, .wheel_base_deviation = 2e-3};
  parameters.gyro_bias = {0.001, 0.002, 0.003};
  Estimator estimator(parameters, two_wheeler(), kPeriod);
  StateFrame state;
  estimator.step(RollingRobot().frame(), state);
  EXPECT_NEAR(state.wheeled.calibration.radius_ratio, 1.004, 1e-15);
  EXPECT_NEAR(state.wheeled.calibration.wheel_base_factor, 1.015, 1e-15);
  EXPECT_NEAR(state.wheeled.calibration.radius_ratio_deviation, 1e-4, 1e-15);
  EXPECT_NEAR(state.wheeled.calibration.wheel_base_deviation, 2e-3, 1e-15);
  EXPECT_EQ(state.base.gyro_bias, (Vector3{0.001, 0.002, 0.003}));
}

// A deviation of 0 holds a value permanently.
TEST(EstimatorCalibration, HoldsWhatIsGivenAsExact) {
  EstimatorParameters parameters;
  parameters.calibration = {
      .radius_ratio = 1.01, .wheel_base_factor = 1.02, .radius_ratio_deviation = 0, .wheel_base_deviation = 0};
  RollingRobot robot;
  Estimator estimator(parameters, two_wheeler(), kPeriod);
  StateFrame state;
  for (int i = 0; i < 20000; ++i) {
    robot.drive(i < 1000 ? 0 : 0.5, i < 1000 ? 0 : 0.5 * std::sin(i * 1e-3));
    estimator.step(robot.frame(), state);
  }
  EXPECT_NEAR(state.wheeled.calibration.radius_ratio, 1.01, 1e-12);
  EXPECT_NEAR(state.wheeled.calibration.wheel_base_factor, 1.02, 1e-12);
}

// The promise for a loss after calibration is at most a fifth of the error of uncalibrated wheel odometry.
TEST_F(EstimatorCalibrationTest, AGyroThatIsLostLeavesCalibratedWheels) {
  practise(120);
  estimator_.set_pose({0, 0, 0});
  drive(0.5, 0.3, 1);
  const double yaw0 = robot_.yaw();
  const Eigen::Vector3d start = robot_.position;
  const double raw_yaw0 = state_.wheeled.odometry.yaw;
  const double raw_x0 = state_.wheeled.odometry.x;
  const double raw_y0 = state_.wheeled.odometry.y;
  robot_.frame().valid &= ~std::uint64_t{kValidGyro};
  for (int i = 0; i < 60000; ++i) drive(0.5, i % 20000 < 10000 ? 0.3 : 0.1, 1);
  const auto in_start = [&](double x, double y, double yaw) {
    return Eigen::Vector2d(Eigen::Rotation2Dd(-yaw) * Eigen::Vector2d(x, y));
  };
  const Eigen::Vector2d truth = in_start(robot_.x() - start.x(), robot_.y() - start.y(), yaw0);
  const Eigen::Vector2d raw =
      in_start(state_.wheeled.odometry.x - raw_x0, state_.wheeled.odometry.y - raw_y0, raw_yaw0);
  const Eigen::Vector2d ours(x(), y());
  EXPECT_TRUE(has(kStateNoGyro));
  EXPECT_TRUE(has(kStateValid));
  EXPECT_GT((raw - truth).norm(), 0.1) << "the case is worth it";
  EXPECT_LT((ours - truth).norm(), (raw - truth).norm() / 5);
}

}  // namespace robot_control::tests
