// The simple part wins where the full law contradicts it without proof of slip.

#include "estimation/simple/supervision.h"

#include "estimation/estimator_fixture.h"

namespace robot_control {
namespace {

class SupervisionTest : public EstimatorFixture, public testing::WithParamInterface<unsigned> {
 protected:
  SupervisionTest() : normal_(0, 1), random_(GetParam()) {}

  /// Shaken as a skid steer is on a floor: in proportion to its speed, white and slow.
  void shaken(double linear, double angular, double seconds) {
    for (int i = 0; i < static_cast<int>(seconds / RollingRobot::kPeriod); ++i) {
      robot_.drive(linear, angular);
      SensorFrame frame = robot_.frame();
      const double share = std::abs(robot_.motion.velocity.x()) / 0.5;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        slow_[axis] += -slow_[axis] * RollingRobot::kPeriod / 3 +
                       0.1 * std::sqrt(2 * RollingRobot::kPeriod / 3) * normal_(random_);
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double white = 0.065 / std::sqrt(RollingRobot::kPeriod) * normal_(random_);
        frame.imu.linear_acceleration[axis] += share * (white + (axis < 2 ? slow_[axis] : 0));
      }
      estimator_.step(frame, state_);
      degraded_ += has(kStateDegraded) ? 1 : 0;
      slipping_ += has(kStateSlip) ? 1 : 0;
    }
  }

  std::normal_distribution<double> normal_;
  std::mt19937 random_;
  std::array<double, 2> slow_{};
  int degraded_ = 0, slipping_ = 0;
};

TEST_P(SupervisionTest, AFloorThatShakesTheAccelerometerCostsNothing) {
  stand(3000);
  for (const double rate : {0.0, 0.3, -0.4, 0.0}) shaken(0.5, rate, 10);
  shaken(0, 0, 3);
  EXPECT_LT(position_error(), 0.02);  // encoders and gyro are exact
  EXPECT_LT(yaw_error(), 0.01);
  EXPECT_LT(slipping_, 0.05 * 43000);
  EXPECT_GT(degraded_, 0);
  EXPECT_TRUE(has(kStateValid));
  EXPECT_NE(state_.degraded, 0U);
  EXPECT_GT(state_.residual_level, 2);
  EXPECT_LT(position_error(), 3 * std::sqrt(state_.pose_covariance[0] + state_.pose_covariance[7]) + 1e-3);
}

// At rest again it says so, and where it is does not move.
TEST_P(SupervisionTest, RestsWhenTheWheelsRest) {
  stand(3000);
  shaken(0.5, 0.2, 10);
  shaken(0, 0, 3);
  const double x_then = x();
  const double y_then = y();
  shaken(0, 0, 5);
  EXPECT_TRUE(has(kStateStandstill));
  EXPECT_LT(std::abs(speed()), 0.002);
  EXPECT_LT(std::hypot(x() - x_then, y() - y_then), 1e-4);
}

TEST_P(SupervisionTest, AnExactRobotIsNeverDegraded) {
  stand(2000);
  for (const double rate : {0.0, 0.5, -1.0, 0.0}) {
    for (int i = 0; i < 5000; ++i) {
      drive(0.5, rate, 1);
      ASSERT_FALSE(has(kStateDegraded)) << i << " " << rate;
    }
  }
}

/// What the accelerometer or the gyro reads for a moment.
class ShortFaultTest : public EstimatorFixture, public testing::WithParamInterface<double> {};

// 20 ms … 3 s of an accelerometer that reads nonsense; 20 s of rest; a drive.
TEST_P(ShortFaultTest, OfTheAccelerometerIsForgottenAtRest) {
  stand(2000);
  drive(0.5, 0.2, 3000);
  for (int i = 0; i < static_cast<int>(GetParam() / RollingRobot::kPeriod); ++i) {
    broken([&](SensorFrame& frame) { frame.imu.linear_acceleration = {i % 2 == 0 ? 80.0 : -20.0, 60, -50}; });
  }
  drive(0, 0, 3000);
  EXPECT_LT(std::abs(speed()), 0.002);
  drive(0, 0, 17000);
  const double x_before = x() - robot_.x();
  const double y_before = y() - robot_.y();
  const Eigen::Vector3d up =
      Eigen::Quaterniond(state_.attitude[3], state_.attitude[0], state_.attitude[1], state_.attitude[2])
          .toRotationMatrix()
          .row(2);
  EXPECT_LT(std::hypot(up.x(), up.y()), 0.0087);  // 0.5°
  const double way = robot_.distance;
  for (int i = 0; i < 10000; ++i) {
    drive(0.5, 0, 1);
    if (i > 1000) {
      ASSERT_NEAR(speed(), 0.5, 0.025) << i;
    }
  }
  EXPECT_LT(std::hypot(x() - robot_.x() - x_before, y() - robot_.y() - y_before), 0.005 * (robot_.distance - way));
}

INSTANTIATE_TEST_SUITE_P(Durations, ShortFaultTest, testing::Values(0.02, 0.3, 1.0, 3.0));
INSTANTIATE_TEST_SUITE_P(Seeds, SupervisionTest, testing::Range(0U, 3U));

}  // namespace
}  // namespace robot_control
