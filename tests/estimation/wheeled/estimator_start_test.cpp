// A run may begin in motion, during a drive, or after a gap in all samples.

#include "estimation/wheeled/estimator_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

struct EstimatorStartTest : EstimatorFixture {
  /// The robot moves and no sample is received.
  void drive_unseen(double linear, double angular, int cycles) {
    for (int i = 0; i < cycles; ++i) robot_.drive(linear, angular);
  }
};

// It drives 12 s at 0.5 m/s. The speed is found from travel, within a count's deviation per 0.1 s; 1 % is ten times
// that.
TEST_F(EstimatorStartTest, ARunThatBeginsInMotionFindsItsSpeed) {
  drive_unseen(0.5, 0.1, 1000);
  observe();
  drive(0.5, 0.1, 12000);
  EXPECT_NEAR(speed(), 0.5, 0.005);
  EXPECT_NEAR(state_.base.distance, 6.0, 0.06);
  EXPECT_EQ(state_.wheeled.slip, 0u);
  EXPECT_TRUE(has(kStateValid));
}

// Tilt and bias are learned at rest, and do not move the robot.
TEST_F(EstimatorStartTest, AFreshRunStandsAtZero) {
  stand();
  EXPECT_LT(std::hypot(state_.base.pose_odom.position[0], state_.base.pose_odom.position[1]), 1e-6);
  const double reading = EstimatorParameters{}.encoder_noise * two_wheeler().wheels[0].radius;  // m
  EXPECT_LT(std::sqrt(state_.base.pose_covariance[0]), 1.01 * reading);
  EXPECT_LT(std::sqrt(state_.base.pose_covariance[7]), 1.01 * reading);
}

TEST_F(EstimatorStartTest, ARestartTakesTheSpeedOfTheWheelsNotThatOfBefore) {
  stand();
  drive(0.5, 0, 2000);
  StateFrame last = state_;
  last.head.cycle = robot_.frame().head.cycle;
  drive_unseen(0.2, 0, 600);
  estimator_.resume(last);
  observe();
  drive(0.2, 0, 5000);
  EXPECT_NEAR(speed(), 0.2, 0.005);
  EXPECT_EQ(state_.wheeled.slip, 0u);
}

// 0.3 s at 0.6 rad/s without a sample, in which the turn begins and ends: only the wheels measure it.
TEST_F(EstimatorStartTest, AHoleInAllSamplesIsTurnedByTheWheels) {
  stand();
  drive(0.3, 0, 2000);
  drive_unseen(0.3, 0.6, 150);
  drive_unseen(0.3, 0, 150);
  drive(0.3, 0, 1000);
  EXPECT_LT(yaw_error(), 5 * std::sqrt(state_.base.pose_covariance[35]));
  EXPECT_LT(yaw_error(), 0.01);
  EXPECT_NEAR(speed(), 0.3, 0.005);
}

TEST_F(EstimatorStartTest, IsNotAtRestWithoutEncoders) {
  stand();
  const Vector3 learned = state_.base.gyro_bias;
  for (int i = 0; i < 3000; ++i) {
    robot_.drive(0, 0.1);
    SensorFrame frame = robot_.frame();
    set_joints_valid(frame, 0);
    estimator_.step(frame, state_);
  }
  EXPECT_FALSE(has(kStateStandstill));
  EXPECT_FALSE(has(kStateValid));
  EXPECT_NEAR(state_.base.gyro_bias[2], learned[2], 1e-3);
  drive(0, 0.1, 2000);
  EXPECT_NEAR(state_.base.twist_base.angular[2], 0.1, 0.005);
  EXPECT_TRUE(has(kStateValid));
}

}  // namespace robot_control::tests
