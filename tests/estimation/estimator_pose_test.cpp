// Where the robot is: the estimator against a truth in closed form, with ideal sensors.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cstring>

#include "estimation/estimator.h"
#include "estimation/rolling_robot.h"
#include "support/allocation_guard.h"

namespace robot_control {
namespace {

constexpr double kPeriod = PlanarRobot::kPeriod;
// 10⁴ additions of numbers of order 1, each rounded to 2⁻⁵³.
constexpr double kRounding = 1e-11;

class EstimatorPoseTest : public testing::Test {
 protected:
  EstimatorPoseTest() { observe(); }

  void observe() { estimator_.step(robot_.frame(), state_); }
  void drive(double linear, double angular, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      robot_.go(linear, angular);
      observe();
    }
  }
  void expect_truth(double tolerance) const {
    EXPECT_NEAR(state_.pose_odom.position[0], robot_.x, tolerance);
    EXPECT_NEAR(state_.pose_odom.position[1], robot_.y, tolerance);
    EXPECT_NEAR(std::remainder(yaw_of(state_.pose_odom) - robot_.yaw, 2 * std::numbers::pi), 0, tolerance);
  }

  PlanarRobot robot_;
  Estimator estimator_{EstimatorParameters{}, two_wheeler(), kPeriod};
  StateFrame state_;
};

/// The gyro reads the angular speed from the first cycle on, so that its trapezoid is exact.
class SteadyMotion : public EstimatorPoseTest, public testing::WithParamInterface<std::pair<double, double>> {};

TEST_P(SteadyMotion, PoseIsExact) {
  const auto [linear, angular] = GetParam();
  robot_.frame().imu.angular_velocity = {0, 0, angular};
  estimator_.reset();
  observe();
  drive(linear, angular, 10000);
  expect_truth(kRounding);
  EXPECT_NEAR(state_.distance, robot_.distance, kRounding);
  EXPECT_NEAR(state_.twist_base.linear[0], linear, 1e-9);
  EXPECT_NEAR(state_.twist_base.angular[2], angular, 1e-9);
  EXPECT_EQ(state_.flags, std::uint64_t{kStateValid});
}

INSTANTIATE_TEST_SUITE_P(EstimatorPose, SteadyMotion,
                         testing::Values(std::pair{0.5, 0.0}, std::pair{0.5, 0.2}, std::pair{-0.5, 0.2},
                                         std::pair{-0.5, 0.0}, std::pair{0.0, 1.0}, std::pair{0.0, -1.0},
                                         std::pair{0.3, -2 * std::numbers::pi / 10}));

TEST_F(EstimatorPoseTest, TwistIsSignedInReverse) {
  drive(-0.5, 0, 1000);
  EXPECT_LT(state_.twist_base.linear[0], -0.49);
  EXPECT_LT(state_.pose_odom.position[0], -0.49);
}

TEST_F(EstimatorPoseTest, FirstEncoderReadingIsTheOffset) {
  PlanarRobot robot;
  robot.frame().joints[0].position = 1234.5;
  robot.frame().joints[1].position = -77;
  estimator_.reset();
  estimator_.step(robot.frame(), state_);
  EXPECT_EQ(state_.pose_odom.position, (Vector3{0, 0, 0}));
  robot.go(0.5, 0);
  estimator_.step(robot.frame(), state_);
  EXPECT_NEAR(state_.pose_odom.position[0], 0.5 * kPeriod, 1e-12);
}

// An axle 0.2 m behind base_link: spinning moves base_link on a circle of that radius.
TEST_F(EstimatorPoseTest, ABaseBesideTheAxleMovesOnItsOwnCircle) {
  RobotModel model = two_wheeler();
  model.wheels[0].centre_base[0] = model.wheels[1].centre_base[0] = -0.2;
  Estimator estimator(EstimatorParameters{}, model, kPeriod);
  PlanarRobot robot(model);
  robot.frame().imu.angular_velocity = {0, 0, 0.5};
  estimator.step(robot.frame(), state_);
  for (int i = 0; i < 2000; ++i) {
    robot.go(0, 0.5);
    estimator.step(robot.frame(), state_);
  }
  EXPECT_NEAR(state_.pose_odom.position[0], -0.2 + 0.2 * std::cos(1.0), kRounding);
  EXPECT_NEAR(state_.pose_odom.position[1], 0.2 * std::sin(1.0), kRounding);
  EXPECT_NEAR(state_.twist_base.linear[1], 0.5 * 0.2, 1e-9);
}

// The middle of the axles is 0.1 m ahead of base_link; v there moves base_link by (v, −0.1 ω).
TEST_F(EstimatorPoseTest, FourWheelsTurnAboutTheirMiddleByTheEffectiveWheelBase) {
  const RobotModel model = four_wheeler();
  Estimator estimator(EstimatorParameters{}, model, kPeriod);
  PlanarRobot robot(model);
  robot.frame().imu.angular_velocity = {0, 0, 0.5};
  estimator.step(robot.frame(), state_);
  for (int i = 0; i < 2000; ++i) {
    robot.go(0.2, 0.5);
    estimator.step(robot.frame(), state_);
  }
  EXPECT_NEAR(yaw_of(state_.pose_odom), 1.0, kRounding);
  EXPECT_NEAR(state_.pose_odom.position[0], robot.x + 0.1 - 0.1 * std::cos(1.0), kRounding);
  EXPECT_NEAR(state_.pose_odom.position[1], robot.y - 0.1 * std::sin(1.0), kRounding);
  EXPECT_NEAR(state_.confidence[kGyro], 1, 1e-9) << "wheels and gyro agree";
}

// Rolled by 180°, the IMU's z looks down.
TEST_F(EstimatorPoseTest, TheGyroIsReadInTheAxesOfItsLink) {
  RobotModel model = two_wheeler();
  model.imu_in_base.orientation = {1, 0, 0, 0};
  Estimator estimator(EstimatorParameters{}, model, kPeriod);
  PlanarRobot robot(model);
  robot.bias = -0.4;  // angular + bias = −angular
  robot.frame().imu.angular_velocity = {0, 0, -0.2};
  estimator.step(robot.frame(), state_);
  for (int i = 0; i < 1000; ++i) {
    robot.go(0.5, 0.2);
    estimator.step(robot.frame(), state_);
  }
  EXPECT_NEAR(yaw_of(state_.pose_odom), 0.2, kRounding);
  EXPECT_NEAR(state_.confidence[kGyro], 1, 1e-9);
}

TEST_F(EstimatorPoseTest, SkippedCyclesAreTravelledAndCounted) {
  robot_.frame().imu.angular_velocity = {0, 0, 0.2};
  estimator_.reset();
  observe();
  drive(0.5, 0.2, 1000);
  robot_.go(0.5, 0.2, 8);
  observe();
  EXPECT_EQ(state_.skipped, 7u);
  EXPECT_NE(state_.flags & kStateSkipped, 0u);
  expect_truth(kRounding);
  EXPECT_NEAR(state_.twist_base.linear[0], 0.5, 1e-9);
  drive(0.5, 0.2, 1);
  EXPECT_EQ(state_.skipped, 7u);
  EXPECT_EQ(state_.flags & kStateSkipped, 0u);
}

TEST_F(EstimatorPoseTest, AFrameSeenBeforeChangesNothing) {
  drive(0.5, 0.2, 100);
  const StateFrame before = state_;
  observe();
  EXPECT_EQ(std::memcmp(&before, &state_, sizeof before), 0);
}

TEST_F(EstimatorPoseTest, ResetPoseIsExactlyZeroInTheNextFrameAndKeepsTheTwist) {
  drive(0.5, 0.2, 1000);
  const double distance = state_.distance;
  estimator_.reset_pose();
  drive(0.5, 0.2, 1);
  EXPECT_EQ(state_.pose_odom.position, (Vector3{0, 0, 0}));
  EXPECT_EQ(state_.pose_odom.orientation, (Quaternion{0, 0, 0, 1}));
  EXPECT_EQ(state_.pose_covariance[0], 0);
  EXPECT_NEAR(state_.twist_base.linear[0], 0.5, 1e-3);
  EXPECT_GT(state_.distance, distance);
}

TEST_F(EstimatorPoseTest, ANewRunStartsAtZero) {
  drive(0.5, 0.2, 1000);
  estimator_.reset();
  PlanarRobot robot;
  robot.frame().joints[0].position = 3;
  estimator_.step(robot.frame(), state_);
  EXPECT_EQ(state_.pose_odom.position, (Vector3{0, 0, 0}));
  EXPECT_EQ(state_.distance, 0);
  EXPECT_EQ(state_.skipped, 0u);
}

TEST_F(EstimatorPoseTest, ARestartContinuesWithoutAJumpAndWithGrownCovariance) {
  drive(0.5, 0.2, 2000);
  StateFrame last = state_;
  last.head.cycle = robot_.frame().head.cycle;
  Estimator restarted(EstimatorParameters{}, two_wheeler(), kPeriod);
  restarted.resume(last);
  robot_.go(0.5, 0.2, 300);
  restarted.step(robot_.frame(), state_);
  EXPECT_EQ(state_.pose_odom.position, last.pose_odom.position);
  EXPECT_NEAR(yaw_of(state_.pose_odom), yaw_of(last.pose_odom), 1e-15);
  EXPECT_EQ(state_.distance, last.distance);
  EXPECT_EQ(state_.skipped, last.skipped + 299);
  EXPECT_NE(state_.flags & kStateRestarted, 0u);
  EXPECT_NE(state_.flags & kStateValid, 0u);
  // The unknown travel is about 0.5 m/s · 0.3 s.
  EXPECT_GT(state_.pose_covariance[0], last.pose_covariance[0] + 0.14 * 0.14);
  EXPECT_GT(state_.pose_covariance[35], last.pose_covariance[35] + 0.05 * 0.05);
  EXPECT_NEAR(state_.twist_base.linear[0], last.twist_base.linear[0], 1e-12);
  robot_.go(0.5, 0.2);
  restarted.step(robot_.frame(), state_);
  const double dx = state_.pose_odom.position[0] - last.pose_odom.position[0];
  const double dy = state_.pose_odom.position[1] - last.pose_odom.position[1];
  EXPECT_NEAR(std::hypot(dx, dy), 0.5 * kPeriod, 1e-9);
  EXPECT_NE(state_.flags & kStateRestarted, 0u);
}

TEST_F(EstimatorPoseTest, ARestartInTheCycleAlreadyPublishedHoldsThePose) {
  drive(0.5, 0.2, 500);
  StateFrame last = state_;
  last.head.cycle = robot_.frame().head.cycle;
  Estimator restarted(EstimatorParameters{}, two_wheeler(), kPeriod);
  restarted.resume(last);
  restarted.step(robot_.frame(), state_);
  EXPECT_EQ(state_.pose_odom.position, last.pose_odom.position);
  EXPECT_EQ(state_.skipped, last.skipped);
}

TEST_F(EstimatorPoseTest, ALastFrameThatIsNotFiniteIsNotContinuedFrom) {
  StateFrame last;
  last.flags = kStateValid;
  last.pose_odom.position[0] = std::nan("");
  Estimator restarted(EstimatorParameters{}, two_wheeler(), kPeriod);
  restarted.resume(last);
  restarted.step(robot_.frame(), state_);
  EXPECT_EQ(state_.pose_odom.position, (Vector3{0, 0, 0}));
  EXPECT_EQ(state_.flags & kStateRestarted, 0u);
}

TEST_F(EstimatorPoseTest, CovarianceGrowsWithDistanceAndWithTurn) {
  drive(0.5, 0, 1000);
  const double position = state_.pose_covariance[0];
  const double yaw = state_.pose_covariance[35];
  EXPECT_GT(position, 0);
  drive(0.5, 0, 1000);
  EXPECT_GT(state_.pose_covariance[0], 1.9 * position);
  const double yaw_straight = state_.pose_covariance[35];
  EXPECT_GT(yaw_straight, yaw);
  drive(0, 1.0, 1000);
  EXPECT_GT(state_.pose_covariance[35], yaw_straight);
}

// Independent wheels of 0.02 m/√m: σ² of the mean of both after d metres is 4e-4 · d / 2.
TEST_F(EstimatorPoseTest, DistanceVarianceIsThatOfTwoIndependentWheels) {
  drive(0.5, 0, 10000);
  EXPECT_NEAR(state_.pose_covariance[0], 4e-4 * 5.0 / 2, 1e-9);
}

TEST_F(EstimatorPoseTest, CovariancesAreSymmetricAndPositive) {
  for (int leg = 0; leg < 20; ++leg) {
    drive(0.5 - 0.05 * leg, 0.3 * std::sin(leg), 500);
    for (const Matrix6& published : {state_.pose_covariance, state_.twist_covariance}) {
      const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> matrix(published.data());
      EXPECT_EQ(matrix, matrix.transpose());
      const Eigen::Matrix<double, 6, 6> copy = matrix;
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(copy);
      EXPECT_GT(solver.eigenvalues().minCoeff(), 0) << "leg " << leg;
    }
  }
}

TEST_F(EstimatorPoseTest, AWheelThatSlipsLowersConfidenceAndRaisesTheFlag) {
  robot_.frame().imu.angular_velocity = {0, 0, 0};
  drive(0.5, 0, 500);
  EXPECT_NEAR(state_.confidence[kLeftEncoder], 1, 1e-9);
  const double before = state_.pose_covariance[0];
  for (int i = 0; i < 500; ++i) {
    robot_.go(0.5, 0);
    robot_.frame().joints[1].position += 10 * kPeriod;  // the right rim is 1 m/s too fast
    observe();
  }
  EXPECT_LT(state_.confidence[kLeftEncoder], 0.02);
  EXPECT_LT(state_.confidence[kGyro], 0.02);
  EXPECT_NE(state_.flags & kStateSlip, 0u);
  EXPECT_GT(state_.pose_covariance[0], 10 * before);
}

TEST_F(EstimatorPoseTest, SameInputsGiveTheSameBits) {
  Estimator first(EstimatorParameters{}, two_wheeler(), kPeriod);
  Estimator second(EstimatorParameters{}, two_wheeler(), kPeriod);
  second.step(robot_.frame(), state_);
  second.reset();
  StateFrame one;
  StateFrame two;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.03);
  for (int i = 0; i < 3000; ++i) {
    robot_.go(0.5 * std::sin(i * 1e-3), 0.2);
    robot_.frame().imu.angular_velocity[2] += noise(random);
    first.step(robot_.frame(), one);
    second.step(robot_.frame(), two);
    ASSERT_EQ(std::memcmp(&one, &two, sizeof one), 0) << "cycle " << i;
  }
}

TEST_F(EstimatorPoseTest, StepsWithoutAllocating) {
  if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer owns the allocator";
  AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    robot_.go(i < 500 ? 0.5 : 0, 0);
    if (i == 300) robot_.frame().imu.angular_velocity[2] = std::nan("");
    if (i == 400) estimator_.reset_pose();
    if (i == 700) estimator_.resume(state_);
    if (i == 800) estimator_.reset();
    observe();
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(EstimatorConstruction, RefusesWhatCannotBe) {
  EXPECT_THROW(Estimator(EstimatorParameters{}, two_wheeler(), 0), std::invalid_argument);
  RobotModel robot = two_wheeler();
  robot.wheel_base = 0;
  EXPECT_THROW(Estimator(EstimatorParameters{}, robot, kPeriod), std::invalid_argument);
  EstimatorParameters parameters;
  parameters.gyro_noise = std::nan("");
  EXPECT_THROW(Estimator(parameters, two_wheeler(), kPeriod), std::invalid_argument);
}

}  // namespace
}  // namespace robot_control
