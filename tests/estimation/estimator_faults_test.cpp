// Samples that are missing, not finite or impossible.

#include <gtest/gtest.h>

#include <limits>

#include "estimation/estimator.h"
#include "estimation/rolling_robot.h"

namespace robot_control {
namespace {

constexpr double kPeriod = PlanarRobot::kPeriod;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool all_finite(const StateFrame& state) {
  bool good = std::isfinite(state.distance);
  for (const double value : state.pose_odom.position) good = good && std::isfinite(value);
  for (const double value : state.pose_odom.orientation) good = good && std::isfinite(value);
  for (const double value : state.twist_base.linear) good = good && std::isfinite(value);
  for (const double value : state.twist_base.angular) good = good && std::isfinite(value);
  for (const double value : state.pose_covariance) good = good && std::isfinite(value);
  for (const double value : state.twist_covariance) good = good && std::isfinite(value);
  for (const double value : state.gyro_bias) good = good && std::isfinite(value);
  for (const double value : state.confidence) good = good && value >= 0 && value <= 1;
  return good;
}

/// Healthy case: half a second of standing, then 0.5 m/s straight ahead.
class EstimatorFaultsTest : public testing::Test {
 protected:
  EstimatorFaultsTest() {
    observe();
    for (int i = 0; i < 500; ++i) next(0);
    for (int i = 0; i < 500; ++i) next(0.5);
  }
  void observe() { estimator_.step(robot_.frame(), state_); }
  void next(double linear = 0.5) {
    robot_.go(linear, 0);
    observe();
  }
  /// One cycle in which `fault` has been at the frame.
  template <class Fault>
  void broken(Fault fault) {
    robot_.go(0.5, 0);
    SensorFrame frame = robot_.frame();
    fault(frame);
    estimator_.step(frame, state_);
  }
  bool has(StateFlag flag) const { return (state_.flags & flag) != 0; }

  PlanarRobot robot_;
  Estimator estimator_{EstimatorParameters{}, two_wheeler(), kPeriod};
  StateFrame state_;
};

TEST_F(EstimatorFaultsTest, HealthySensorsRaiseNoFlag) {
  EXPECT_EQ(state_.flags, std::uint64_t{kStateValid});
}

TEST_F(EstimatorFaultsTest, AnEncoderThatIsNotFiniteHoldsThePoseForACycle) {
  const double before = state_.pose_odom.position[0];
  for (const double value : {kNaN, kInfinity, -kInfinity}) {
    broken([&](SensorFrame& frame) { frame.joints[1].position = value; });
    EXPECT_TRUE(has(kStateBadSample));
    EXPECT_TRUE(has(kStateValid));
    EXPECT_EQ(state_.pose_odom.position[0], before);
    EXPECT_EQ(state_.confidence[kRightEncoder], 0);
  }
  next();
  EXPECT_FALSE(has(kStateBadSample));
  EXPECT_NEAR(state_.pose_odom.position[0], before + 4 * 0.5 * kPeriod, 1e-12);
}

TEST_F(EstimatorFaultsTest, EncodersMissingForLongAreNoValidState) {
  const auto lose = [](SensorFrame& frame) { frame.valid &= ~std::uint64_t{kValidJoints}; };
  for (std::uint64_t i = 0; i < Estimator::kMaxHeld; ++i) {
    broken(lose);
    EXPECT_TRUE(has(kStateValid)) << i;
  }
  broken(lose);
  EXPECT_FALSE(has(kStateValid));
  next();
  EXPECT_TRUE(has(kStateValid));
}

TEST_F(EstimatorFaultsTest, NoEncoderEverIsNoValidState) {
  Estimator estimator(EstimatorParameters{}, two_wheeler(), kPeriod);
  PlanarRobot robot;
  robot.frame().joint_count = 0;
  estimator.step(robot.frame(), state_);
  EXPECT_FALSE(has(kStateValid));
  EXPECT_TRUE(all_finite(state_));
}

TEST_F(EstimatorFaultsTest, AnImpossibleEncoderIsNotBelieved) {
  const double before = state_.pose_odom.position[0];
  broken([](SensorFrame& frame) { frame.joints[0].position = 1e300; });
  EXPECT_TRUE(has(kStateBadSample));
  EXPECT_EQ(state_.pose_odom.position[0], before);
  next();
  EXPECT_NEAR(state_.pose_odom.position[0], before + 2 * 0.5 * kPeriod, 1e-12);
}

TEST_F(EstimatorFaultsTest, AnEncoderThatBeganAnewCostsCovarianceNotAJump) {
  const Vector3 before = state_.pose_odom.position;
  const double variance = state_.pose_covariance[0];
  robot_.frame().joints[0].position = robot_.frame().joints[1].position = -500;
  for (std::uint64_t i = 0; i <= WheelEncoders::kMaxRejected; ++i) next();
  EXPECT_EQ(state_.pose_odom.position, before);
  EXPECT_GT(state_.pose_covariance[0], variance + 0.002);
  next();
  EXPECT_NEAR(state_.pose_odom.position[0], before[0] + 0.5 * kPeriod, 1e-12);
}

TEST_F(EstimatorFaultsTest, WithoutGyroTheWheelsTurnAlone) {
  for (int i = 0; i < 1000; ++i) {
    robot_.go(0.5, 0.2);
    robot_.frame().valid = kValidJoints;
    robot_.frame().imu.angular_velocity = {0, 0, kNaN};
    observe();
    ASSERT_TRUE(has(kStateNoGyro));
    ASSERT_FALSE(has(kStateBadSample));  // it was not offered
  }
  EXPECT_NEAR(yaw_of(state_.pose_odom), 0.2, 1e-12);
  EXPECT_EQ(state_.confidence[kGyro], 0);
  EXPECT_EQ(state_.confidence[kLeftEncoder], 1);
  EXPECT_NEAR(state_.twist_base.angular[2], 0.2, 1e-6);
}

TEST_F(EstimatorFaultsTest, AGyroSampleThatIsNotFiniteCostsTwoCyclesOfGyro) {
  for (const double value : {kNaN, kInfinity, 1e9}) {
    broken([&](SensorFrame& frame) { frame.imu.angular_velocity[1] = value; });
    EXPECT_TRUE(has(kStateNoGyro));
    EXPECT_TRUE(has(kStateBadSample));
    next();  // a trapezoid takes two samples
    EXPECT_TRUE(has(kStateNoGyro));
    EXPECT_FALSE(has(kStateBadSample));
    next();
    EXPECT_EQ(state_.flags, std::uint64_t{kStateValid});
  }
}

TEST_F(EstimatorFaultsTest, AnAccelerometerThatIsNotFiniteIsOnlyNotUsed) {
  broken([](SensorFrame& frame) { frame.imu.linear_acceleration = {kNaN, kInfinity, 1e308}; });
  EXPECT_TRUE(has(kStateBadSample));
  EXPECT_EQ(state_.confidence[kAccelerometer], 0);
  next();
  EXPECT_EQ(state_.flags, std::uint64_t{kStateValid});
  EXPECT_NEAR(state_.confidence[kAccelerometer], 1, 1e-6);
}

TEST_F(EstimatorFaultsTest, AnAccelerometerWithoutGravityLosesConfidence) {
  for (int i = 0; i < 1000; ++i) {
    broken([](SensorFrame& frame) { frame.imu.linear_acceleration = {0, 0, 0}; });
  }
  EXPECT_LT(state_.confidence[kAccelerometer], 1e-9);
}

TEST_F(EstimatorFaultsTest, RandomGarbageNeverPoisonsTheState) {
  const double garbage[] = {kNaN, kInfinity, -kInfinity, 1e308, -1e308, 1e-320, 0.0, 5.0};
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&] { return garbage[random() % std::size(garbage)]; };
    for (int i = 0; i < 400; ++i) {
      broken([&](SensorFrame& frame) {
        if (random() % 2 == 0) return;
        frame.valid = random();
        frame.joint_count = random() % 40;
        frame.head.cycle += random() % 3;
        frame.joints[0] = {pick(), pick(), pick(), pick()};
        frame.joints[1].position = pick();
        frame.imu.angular_velocity = {pick(), pick(), pick()};
        frame.imu.linear_acceleration = {pick(), pick(), pick()};
      });
      ASSERT_TRUE(all_finite(state_)) << "seed " << seed << " cycle " << i;
    }
    robot_.frame().head.cycle += 10;
    for (int i = 0; i < 10; ++i) next();
    ASSERT_TRUE(has(kStateValid)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace robot_control
