// Standing: the gyro's bias is learned, and nothing moves.

#include <gtest/gtest.h>

#include "estimation/estimator.h"
#include "estimation/rolling_robot.h"

namespace robot_control {
namespace {

constexpr double kPeriod = PlanarRobot::kPeriod;

class EstimatorStandstillTest : public testing::Test {
 protected:
  void drive(double linear, double angular, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      robot_.go(linear, angular);
      estimator_.step(robot_.frame(), state_);
    }
  }
  void stand_noisily(int cycles) {
    std::normal_distribution<double> gyro(0, 1e-3 / std::sqrt(kPeriod));  // white, 1e-3 rad/s/√Hz
    std::normal_distribution<double> acceleration(0, 0.05);
    for (int i = 0; i < cycles; ++i) {
      robot_.go(0, 0);
      robot_.frame().imu.angular_velocity[2] += gyro(random_);
      robot_.frame().imu.linear_acceleration = {acceleration(random_), acceleration(random_),
                                                9.80665 + acceleration(random_)};
      estimator_.step(robot_.frame(), state_);
    }
  }
  bool standing() const { return (state_.flags & kStateStandstill) != 0; }

  PlanarRobot robot_;
  Estimator estimator_{EstimatorParameters{}, two_wheeler(), kPeriod};
  StateFrame state_;
  std::mt19937 random_{11};
};

// The first frame is the offset; the window counts the 250 cycles behind it.
TEST_F(EstimatorStandstillTest, IsSaidAfterOneQuietWindow) {
  drive(0, 0, 1);
  drive(0, 0, 249);
  EXPECT_FALSE(standing());
  drive(0, 0, 1);
  EXPECT_TRUE(standing());
}

TEST_F(EstimatorStandstillTest, EndsWhenAWheelMoves) {
  drive(0, 0, 300);
  drive(0.5, 0, 1);  // 0.5 mm, twice the tolerance of 0.25 mm
  EXPECT_FALSE(standing());
}

TEST_F(EstimatorStandstillTest, LearnsAConstantBiasExactlyInTheLimit) {
  robot_.bias = 0.03;
  drive(0, 0, 20000);
  // First window: gain 0.0025 / (0.0025 + 4e-6); after 79 more the error is below 1e-6 of it.
  EXPECT_NEAR(state_.gyro_bias[2], 0.03, 1e-5);
  EXPECT_EQ(yaw_of(state_.pose_odom), 0);
}

// 20 s of 1e-3 rad/s/√Hz: the mean is known to 1e-3 / √20 = 2.2e-4 rad/s; five of these.
TEST_F(EstimatorStandstillTest, LearnsTheBiasUnderNoise) {
  robot_.bias = -0.02;
  stand_noisily(20000);
  EXPECT_TRUE(standing());
  EXPECT_NEAR(state_.gyro_bias[2], -0.02, 1.1e-3);
}

TEST_F(EstimatorStandstillTest, NeitherPoseNorCovarianceMovesUnderNoise) {
  stand_noisily(2000);
  const StateFrame before = state_;
  stand_noisily(20000);
  EXPECT_EQ(state_.pose_odom.position, before.pose_odom.position);
  EXPECT_EQ(state_.pose_odom.orientation, before.pose_odom.orientation);
  EXPECT_EQ(state_.pose_covariance, before.pose_covariance);
  EXPECT_EQ(state_.distance, 0);
}

TEST_F(EstimatorStandstillTest, CovarianceStopsGrowingAfterADrive) {
  drive(0, 0, 1000);
  drive(0.5, 0.2, 2000);
  drive(0, 0, 1000);
  const StateFrame before = state_;
  drive(0, 0, 5000);
  EXPECT_EQ(state_.pose_covariance, before.pose_covariance);
}

TEST_F(EstimatorStandstillTest, FreezesTheBiasWhileDriving) {
  robot_.bias = 0.01;
  drive(0, 0, 2000);
  const Vector3 learned = state_.gyro_bias;
  drive(0.5, 0.2, 5000);
  EXPECT_EQ(state_.gyro_bias, learned);
}

TEST_F(EstimatorStandstillTest, DoesNotLearnFromAGyroThatTurnsWithHeldWheels) {
  drive(0, 0, 2000);
  const Vector3 learned = state_.gyro_bias;
  robot_.bias = 0.5;  // the robot is turned on ice; the gyro tells
  drive(0, 0, 5000);
  EXPECT_FALSE(standing());
  // The window in which the turn begins may hold it up to the tolerance of 0.013 rad/s, with a gain of 1/8.
  EXPECT_NEAR(state_.gyro_bias[2], learned[2], 0.013 / 8);
  EXPECT_GT(yaw_of(state_.pose_odom), 0.45 * 5 - 0.2);
}

TEST_F(EstimatorStandstillTest, DoesNotLearnWhileTheAccelerometerShakes) {
  robot_.bias = 0.02;
  for (int i = 0; i < 3000; ++i) {
    robot_.go(0, 0);
    robot_.frame().imu.linear_acceleration[0] = i % 2 == 0 ? 1.0 : -1.0;
    estimator_.step(robot_.frame(), state_);
  }
  EXPECT_FALSE(standing());
  EXPECT_EQ(state_.gyro_bias[2], 0);
}

TEST_F(EstimatorStandstillTest, LearnsWithoutAnAccelerometer) {
  robot_.frame().valid = kValidJoints | kValidGyro;
  robot_.bias = 0.02;
  drive(0, 0, 5000);
  EXPECT_NEAR(state_.gyro_bias[2], 0.02, 1e-4);
  EXPECT_EQ(state_.confidence[kAccelerometer], 0);
}

// What the bias is learned for: 30 s at 0.02 rad/s of uncorrected bias would be 0.6 rad.
TEST_F(EstimatorStandstillTest, ALearnedBiasKeepsTheYawOfALongDrive) {
  robot_.bias = 0.02;
  drive(0, 0, 10000);
  drive(0.5, 0, 30000);
  EXPECT_NEAR(yaw_of(state_.pose_odom), 0, 0.002);
}

TEST_F(EstimatorStandstillTest, AnEncoderThatFlickersByOneCountStillStands) {
  const double count = 2 * std::numbers::pi / 4096;
  for (int i = 0; i < 2000; ++i) {
    robot_.go(0, 0);
    robot_.frame().joints[0].position = i % 3 == 0 ? count : 0;
    estimator_.step(robot_.frame(), state_);
  }
  EXPECT_TRUE(standing());
  EXPECT_LT(std::abs(state_.pose_odom.position[0]), 0.1 * count);
}

}  // namespace
}  // namespace robot_control
