// At standstill biases are learned, and nothing moves.

#include "estimation/wheeled/estimator_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

constexpr int kWindow = 250;  // cycles, standstill_time

struct EstimatorStandstillTest : EstimatorFixture {
  EstimatorStandstillTest() { observe(); }
  bool standing() const { return has(kStateStandstill); }
  double tolerance() const {  // m, of a wheel's travel in a window
    const EstimatorParameters parameters;
    return parameters.standstill_speed * parameters.standstill_time * two_wheeler().wheels[0].radius;
  }
};

// After n windows of variance r = noise²/T the prior p pulls by r/(n p + r), and the walk by next to nothing.
TEST_F(EstimatorStandstillTest, LearnsAConstantBiasExactlyInTheLimit) {
  robot_ = RollingRobot();
  estimator_.enter_run();
  robot_.gyro_bias.z() = 0.03;
  robot_.go({});
  observe();
  drive(0, 0, 80 * kWindow);
  const EstimatorParameters parameters;
  const double noise = parameters.gyro_noise;
  const double r = noise * noise / parameters.standstill_time;
  const double p = parameters.gyro_bias_initial * parameters.gyro_bias_initial;
  EXPECT_NEAR(state_.base.gyro_bias[2], 0.03, 0.03 * r / (80 * p) * 1.1);
  EXPECT_EQ(yaw(), 0);
}

// 20 s of 1e-3 rad/s/√Hz: the mean is known to 1e-3/√20 = 2.2e-4 rad/s; four of these for each of three axes.
TEST_F(EstimatorStandstillTest, LearnsTheBiasUnderNoise) {
  robot_.gyro_bias = {0.01, -0.015, -0.02};
  robot_.noise = {.gyro = 1e-3, .accelerometer = 5e-3, .counts = 0};
  drive(0, 0, 20000);
  EXPECT_TRUE(standing());
  for (const int axis : {0, 1, 2}) {
    EXPECT_NEAR(state_.base.gyro_bias[static_cast<std::size_t>(axis)], robot_.gyro_bias[axis],
                4 * 1e-3 / std::sqrt(20.0));
  }
}

// Noise as in the parameters: the published deviation is that of the mean as the samples scatter, 2.44e-4/√T,
// and the error is within it. One window of twenty does not count yet: √(20/19) = 1.03.
TEST_F(EstimatorStandstillTest, KnowsHowWellItKnowsTheBias) {
  const EstimatorParameters parameters;
  robot_.gyro_bias.z() = 0.01;
  robot_.noise = {.gyro = parameters.gyro_noise, .accelerometer = 1e-3, .counts = 0};
  drive(0, 0, 20 * kWindow);
  const double expected = parameters.gyro_noise / std::sqrt(20 * parameters.standstill_time);
  EXPECT_NEAR(state_.base.gyro_bias_deviation[2], expected, 0.1 * expected);
  EXPECT_NEAR(state_.base.gyro_bias[2], 0.01, 4 * expected);
}

TEST_F(EstimatorStandstillTest, NeitherPoseNorItsCovarianceMovesUnderNoise) {
  robot_.noise = {.gyro = 1e-3, .accelerometer = 5e-3, .counts = 0};
  drive(0, 0, 2000);
  const StateFrame before = state_;
  drive(0, 0, 20000);
  EXPECT_EQ(x(), before.base.pose_odom.position[0]);
  EXPECT_EQ(y(), before.base.pose_odom.position[1]);
  // The yaw is the part of the turn that the tilt leaves; it is learned, and does not turn about the vertical.
  EXPECT_NEAR(yaw(), yaw_of(before.base.pose_odom), 1e-6);
  EXPECT_LE(state_.base.pose_covariance[0], before.base.pose_covariance[0] * (1 + 1e-12));
  EXPECT_LE(state_.base.pose_covariance[7], before.base.pose_covariance[7] * (1 + 1e-12));
  EXPECT_LE(state_.base.pose_covariance[35], before.base.pose_covariance[35] + 1e-9);  // 3·10⁻⁵ rad
  EXPECT_EQ(state_.base.distance, 0);
  EXPECT_EQ(speed(), 0);
}

// Promised: yaw drift ≤ 0.01°, position ≤ 0.1 mm. In the first minute of a rest the bias gets known better than it was
// on the way, which makes the way right.
TEST_F(EstimatorStandstillTest, TenMinutesAtRestKeepThePose) {
  robot_.noise = {.gyro = 2.44e-4, .accelerometer = 2e-3, .counts = 4096};
  robot_.gyro_bias = {0.001, -0.002, 0.0017};  // 0.1 °/s
  drive(0, 0, 2000);
  drive(0.5, 0.3, 3000);
  drive(0, 0, 1000);
  ASSERT_TRUE(standing());
  const double stopped = yaw_error();
  drive(0, 0, 60000);
  EXPECT_LE(yaw_error(), stopped);
  const StateFrame before = state_;
  for (int second = 0; second < 600; ++second) {
    robot_.gyro_bias.z() += (second % 2 == 0 ? 1 : -1) * 1e-5;  // as it walks in a second
    drive(0, 0, 1000);
    ASSERT_TRUE(standing()) << second;
  }
  EXPECT_NEAR(yaw(), yaw_of(before.base.pose_odom), 0.01 * std::numbers::pi / 180);
  EXPECT_NEAR(x(), before.base.pose_odom.position[0], 1e-4);
  EXPECT_NEAR(y(), before.base.pose_odom.position[1], 1e-4);
}

TEST_F(EstimatorStandstillTest, CovarianceStopsGrowingAfterADrive) {
  drive(0, 0, 1000);
  drive(0.5, 0.2, 2000);
  drive(0, 0, 2000);
  ASSERT_TRUE(standing());
  const StateFrame before = state_;
  drive(0, 0, 5000);
  for (const std::size_t i : {0U, 7U, 35U})
    EXPECT_LE(state_.base.pose_covariance[i], before.base.pose_covariance[i] + 1e-15);
}

// The bias is learned at rest and changes while driving at most by its random walk: three of its deviations.
TEST_F(EstimatorStandstillTest, ALearnedBiasIsKeptWhileDriving) {
  robot_.gyro_bias.z() = 0.01;
  drive(0, 0, 2000);
  const double learned = state_.base.gyro_bias[2];
  const double deviation = state_.base.gyro_bias_deviation[2];
  drive(0.5, 0.2, 5000);
  EXPECT_NEAR(state_.base.gyro_bias[2], learned, 3 * deviation);
}

TEST_F(EstimatorStandstillTest, DoesNotLearnFromAGyroThatTurnsWithHeldWheels) {
  drive(0, 0, 2000);
  const double learned = state_.base.gyro_bias[2];
  robot_.tread = {0.0, 0.0};
  const double before = robot_.yaw();
  drive(0, 0.5, 3000);  // the robot turns on ice, which the gyro measures
  EXPECT_FALSE(standing());
  // The window in which the turn begins may hold standstill_speed, and no gain is above 1/8 by then.
  EXPECT_NEAR(state_.base.gyro_bias[2], learned, EstimatorParameters{}.standstill_speed / 8);
  EXPECT_NEAR(std::remainder(yaw() - robot_.yaw(), 2 * std::numbers::pi), 0, 0.02 * (robot_.yaw() - before));
}

TEST_F(EstimatorStandstillTest, LearnsWithoutAnAccelerometer) {
  set_joints_valid(robot_.frame(), kValidMotion);
  robot_.frame().valid = kValidGyro;
  robot_.gyro_bias.z() = 0.02;
  drive(0, 0, 5000);
  EXPECT_NEAR(state_.base.gyro_bias[2], 0.02, 1e-4);
  EXPECT_EQ(state_.wheeled.confidence[kAccelerometer], 0);
  EXPECT_TRUE(has(kStateNoAccelerometer));
}

// 30 s at 0.02 rad/s of uncorrected bias would be 0.6 rad; a rest of 10 s gives the bias to 2.44e-4/√10 rad/s.
TEST_F(EstimatorStandstillTest, ALearnedBiasKeepsTheYawOfALongDrive) {
  robot_.gyro_bias.z() = 0.02;
  drive(0, 0, 10000);
  drive(0.5, 0, 30000);
  EXPECT_NEAR(yaw(), 0, 30 * EstimatorParameters{}.gyro_noise / std::sqrt(10.0));
}

// The creep is slower than the tolerance in a window: nothing is lost at its end, either.
TEST_F(EstimatorStandstillTest, ACreepThatIsTakenForRestIsMadeGoodWhenItEnds) {
  drive(0, 0, 1000);
  const double creep = 0.5 * tolerance() / (kWindow * kPeriod);
  robot_.go({.velocity = {creep, 0, 0}, .rate = {0, 0, 0}});
  observe();
  for (int i = 0; i < kWindow / 2; ++i) {
    robot_.go(robot_.motion);
    observe();
  }
  EXPECT_EQ(x(), 0);
  drive(0.5, 0, 200);
  // The motion in a completed window is at most its tolerance.
  EXPECT_NEAR(x(), robot_.x(), tolerance());
}

}  // namespace robot_control::tests
