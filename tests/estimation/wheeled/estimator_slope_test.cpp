// The ground is not level: height, roll and pitch in three dimensions, or the horizontal projection.

#include "estimation/wheeled/estimator_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

constexpr double kSlope = 0.1;  // rad, upwards
constexpr double kTime = 1.0;   // s, in which the robot pitches
constexpr double kSpeed = 0.5;

/// The robot drives from level ground onto a ramp: the body pitches up about its contacts by kSlope, evenly accelerated
/// and braked. On the ramp the way s rises by s sin(slope) and reaches s cos(slope) far.
struct EstimatorSlopeTest : testing::TestWithParam<bool> {
  EstimatorSlopeTest() {
    parameters_.planar = GetParam();
    model_.imu_in_base.position = {0.05, 0.02, 0.15};
  }
  void climb(RollingRobot& robot, Estimator& estimator) {
    for (int i = 0; i < 1000; ++i) step(robot, estimator, 0);
    for (int i = 0; i < 2000; ++i) step(robot, estimator, kSpeed);
    const int half = static_cast<int>(kTime / 2 / kPeriod);
    const double acceleration = kSlope / (kTime / 2 * kTime / 2);
    for (int i = 1; i <= 2 * half; ++i) {  // nose up is a turn about −y
      step(robot, estimator, kSpeed, -acceleration * kPeriod * (i < half ? i : 2 * half - i));
    }
  }
  void step(RollingRobot& robot, Estimator& estimator, double speed, double pitch_rate = 0) {
    robot.drive(speed, 0, pitch_rate);
    estimator.step(robot.frame(), state_);
  }
  DriveTrain model_ = two_wheeler();
  EstimatorParameters parameters_ = rigid_tyres();
  StateFrame state_;
};

TEST_P(EstimatorSlopeTest, TheWayOnARampIsThatOfItsClosedForm) {
  RollingRobot robot(model_);
  Estimator estimator(parameters_, model_, kPeriod);
  climb(robot, estimator);
  const Eigen::Vector3d at_foot = robot.position;
  const double x = state_.base.pose_odom.position[0];
  const double z = state_.base.pose_odom.position[2];
  for (int i = 0; i < 6000; ++i) step(robot, estimator, kSpeed);
  const double travel = kSpeed * 6000 * kPeriod;
  ASSERT_NEAR(robot.position.z() - at_foot.z(), travel * std::sin(kSlope), 1e-4) << "the truth itself";
  EXPECT_NEAR(state_.base.pose_odom.position[0] - x, travel * std::cos(kSlope), 0.002 * travel);
  EXPECT_EQ(state_.wheeled.slip, 0u);
  EXPECT_TRUE(state_.base.flags & kStateValid);
  // Attitude is always published; nose up is a negative pitch.
  const double pitch = 2 * std::asin(state_.base.attitude[1]);
  EXPECT_NEAR(pitch, -kSlope, 3 * std::sqrt(state_.base.attitude_covariance[4]) + 1e-3);
  EXPECT_NEAR(state_.base.attitude[0], 0, 1e-3);
  if (GetParam()) {
    EXPECT_EQ(state_.base.pose_odom.position[2], 0);
    EXPECT_EQ(state_.base.pose_odom.orientation[0], 0);
    EXPECT_EQ(state_.base.pose_odom.orientation[1], 0);
    EXPECT_EQ(state_.base.twist_base.linear[2], 0);
    EXPECT_EQ(state_.base.pose_covariance[14], Tuning::kPlanarVariance);
  } else {
    EXPECT_NEAR(state_.base.pose_odom.position[2] - z, travel * std::sin(kSlope), 0.01 * travel);
    EXPECT_EQ(state_.base.pose_odom.orientation, state_.base.attitude);
    EXPECT_TRUE(is_covariance(state_.base.pose_covariance, 1e-12));
  }
}

TEST_P(EstimatorSlopeTest, ARestartKeepsTheHeight) {
  RollingRobot robot(model_);
  Estimator estimator(parameters_, model_, kPeriod);
  climb(robot, estimator);
  for (int i = 0; i < 2000; ++i) step(robot, estimator, kSpeed);
  StateFrame last = state_;
  last.head.cycle = robot.frame().head.cycle;
  ASSERT_TRUE(GetParam() || last.base.pose_odom.position[2] > 0.05);
  Estimator restarted(parameters_, model_, kPeriod);
  restarted.resume(last);
  step(robot, restarted, kSpeed);
  EXPECT_NEAR(state_.base.pose_odom.position[2], last.base.pose_odom.position[2], 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Planar, EstimatorSlopeTest, testing::Bool(), [](const testing::TestParamInfo<bool>& planar) {
  return planar.param ? "Projected" : "InThreeDimensions";
});

// It stands on a ramp when it is switched on: tilt and bias cannot be separated, and it does not move.
TEST(EstimatorOnARamp, StartsWithTheTiltThatItStandsAt) {
  EstimatorParameters parameters;
  parameters.planar = false;
  RollingRobot robot;
  robot.rotation = Eigen::AngleAxisd(-kSlope, Eigen::Vector3d::UnitY()).toRotationMatrix();
  Estimator estimator(parameters, two_wheeler(), kPeriod);
  StateFrame state;
  for (int i = 0; i < 3000; ++i) {
    robot.drive(0, 0);
    estimator.step(robot.frame(), state);
  }
  EXPECT_NE(state.base.flags & kStateStandstill, 0u);
  // The prior of 0.1 rad against a bias of 0.2 m/s²: the share of the bias is 0.2²/(0.2² + 0.98²) = 4 %.
  EXPECT_NEAR(2 * std::asin(state.base.attitude[1]), -kSlope, 0.06 * kSlope);
  EXPECT_EQ(state.base.pose_odom.position, (Vector3{0, 0, 0}));
}

}  // namespace robot_control::tests
