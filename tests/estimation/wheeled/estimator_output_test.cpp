// The published state describes base_link, in its axes or in odom's, with covariances.

#include "estimation/wheeled/estimator_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

constexpr double kAhead = 0.2;  // m, of base_link from the axle

/// The same wheels are under a base_link on the axle and one ahead of it. Slip detection is off, because the IMUs
/// differ.
struct EstimatorLeverTest : testing::Test {
  EstimatorLeverTest() {
    for (int i = 0; i < 2000; ++i) step(0, 0);
    for (Estimator* estimator : {&middle_, &ahead_}) estimator->set_pose({0, 0, 0});
    for (int i = 0; i < 3000; ++i) step(0.4, 0.6 * std::sin(i * 1e-3));
  }
  static DriveTrain model(double axle) {
    DriveTrain model = two_wheeler();
    for (WheelModel& wheel : model.wheels) wheel.centre_base[0] = axle;
    return model;
  }
  static EstimatorParameters parameters() {
    EstimatorParameters parameters = rigid_tyres();
    parameters.slip_detection = false;
    return parameters;
  }
  void step(double linear, double angular) {
    robot_.drive(linear, angular);
    middle_.step(robot_.frame(), of_middle_);
    ahead_.step(robot_.frame(), of_ahead_);
  }
  RollingRobot robot_;
  Estimator middle_{parameters(), model(0), kPeriod};
  Estimator ahead_{parameters(), model(-kAhead), kPeriod};
  StateFrame of_middle_;
  StateFrame of_ahead_;
};

TEST_F(EstimatorLeverTest, ThePoseIsThatOfBaseLink) {
  const double yaw = yaw_of(of_middle_.base.pose_odom);
  EXPECT_NEAR(yaw_of(of_ahead_.base.pose_odom), yaw, 1e-12);
  EXPECT_NEAR(of_ahead_.base.pose_odom.position[0],
              of_middle_.base.pose_odom.position[0] + kAhead * (std::cos(yaw) - 1), 1e-9);
  EXPECT_NEAR(of_ahead_.base.pose_odom.position[1], of_middle_.base.pose_odom.position[1] + kAhead * std::sin(yaw),
              1e-9);
}

// An error of the yaw swings base_link about the axle: P = J P J'.
TEST_F(EstimatorLeverTest, ThePosesCovarianceIsThatOfBaseLink) {
  const double yaw = yaw_of(of_middle_.base.pose_odom);
  Eigen::Matrix<double, 6, 6> by = Eigen::Matrix<double, 6, 6>::Identity();
  by(0, 5) = -kAhead * std::sin(yaw);
  by(1, 5) = kAhead * std::cos(yaw);
  const Eigen::Matrix<double, 6, 6> p =
      Eigen::Map<const Eigen::Matrix<double, 6, 6>>(of_middle_.base.pose_covariance.data());
  const Eigen::Matrix<double, 6, 6> expected = by * p * by.transpose();
  const Eigen::Map<const Eigen::Matrix<double, 6, 6>> known(of_ahead_.base.pose_covariance.data());
  for (const int i : {0, 1, 5}) {
    for (const int k : {0, 1, 5}) {
      EXPECT_NEAR(known(i, k), expected(i, k), 1e-9 * std::sqrt(expected(i, i) * expected(k, k))) << i << ", " << k;
    }
  }
}

TEST_F(EstimatorLeverTest, TheTwistIsThatOfBaseLink) {
  EXPECT_NEAR(of_ahead_.base.twist_base.linear[0], of_middle_.base.twist_base.linear[0], 1e-12);
  EXPECT_NEAR(of_ahead_.base.twist_base.linear[1], kAhead * of_middle_.base.twist_base.angular[2], 1e-12);
  EXPECT_NEAR(of_ahead_.base.twist_covariance[7],
              of_middle_.base.twist_covariance[7] + kAhead * kAhead * of_middle_.base.twist_covariance[35], 1e-12);
}

// The covariance grows by the restart's constants; that of the yaw moves base_link, too. The clock offset is unknown
// again. If the wheels are late, which is as probable as a late gyro, the robot is ahead of them by its speed times the
// offset.
TEST_F(EstimatorLeverTest, ARestartKeepsTheCovariance) {
  for (int i = 0; i < 2000; ++i) step(0.4, 0);
  const auto expect_kept = [&](const StateFrame& before, double axle) {
    StateFrame last = before;
    last.head.cycle = robot_.frame().head.cycle;
    Estimator restarted(parameters(), model(axle), kPeriod);
    restarted.resume(last);
    StateFrame state;
    restarted.step(robot_.frame(), state);
    const double yaw = Tuning::kRestart * Tuning::kRestart;
    const double position = Tuning::kRestart * Tuning::kRestart;
    const double late = 0.4 * PlanarCoreParams{}.clock_offset;
    const double reading = EstimatorParameters{}.encoder_noise * two_wheeler().wheels[0].radius;
    EXPECT_NEAR(state.base.pose_covariance[35], before.base.pose_covariance[35] + yaw, 1e-9) << axle;
    EXPECT_NEAR(state.base.pose_covariance[0] + state.base.pose_covariance[7],
                before.base.pose_covariance[0] + before.base.pose_covariance[7] + 2 * position + axle * axle * yaw +
                    late * late / 2 + reading * reading,
                1e-9)
        << axle;
  };
  expect_kept(of_middle_, 0);
  expect_kept(of_ahead_, -kAhead);
}

// Deviations of the bias are published in the IMU's axes, and continued from these. After a drive without a rest that
// about the vertical differs from those of tilting.
TEST(EstimatorOutput, ARestartKeepsTheDeviationsOfTheBias) {
  DriveTrain model = two_wheeler();
  model.imu_in_base.orientation = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // its y axis upwards
  RollingRobot robot(model);
  Estimator estimator(rigid_tyres(), model, kPeriod);
  StateFrame state;
  for (int i = 0; i < 100000; ++i) {
    robot.drive(i < 1000 ? 0 : 0.5, i < 1000 ? 0 : 0.4 * std::sin(i * 5e-4));
    estimator.step(robot.frame(), state);
  }
  StateFrame last = state;
  last.head.cycle = robot.frame().head.cycle;
  Estimator restarted(rigid_tyres(), model, kPeriod);
  restarted.resume(last);
  restarted.step(robot.frame(), state);
  ASSERT_GT(std::abs(last.base.gyro_bias_deviation[1] - last.base.gyro_bias_deviation[2]),
            0.005 * last.base.gyro_bias_deviation[1]);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(state.base.gyro_bias_deviation[i], last.base.gyro_bias_deviation[i],
                1e-3 * last.base.gyro_bias_deviation[i])
        << i;
  }
}

class EstimatorPlaneTest : public testing::TestWithParam<bool> {};

// The nose rises at 0.05 rad/s.
TEST_P(EstimatorPlaneTest, ThePitchRateIsPublishedOutsideOfThePlaneAlone) {
  EstimatorParameters parameters = rigid_tyres();
  parameters.planar = GetParam();
  RollingRobot robot;
  Estimator estimator(parameters, two_wheeler(), kPeriod);
  StateFrame state;
  for (int i = 0; i < 4000; ++i) {
    robot.drive(i < 1000 ? 0 : 0.5, 0, i < 2500 ? 0 : -0.05);
    estimator.step(robot.frame(), state);
  }
  EXPECT_NEAR(state.base.twist_base.angular[1], GetParam() ? 0 : -0.05, 1e-4);
  EXPECT_EQ(state.base.twist_base.linear[2], 0);
  EXPECT_NEAR(2 * std::asin(state.base.attitude[1]), -0.05 * 1.5, 2e-3);
  if (GetParam()) {
    EXPECT_EQ(state.base.pose_odom.orientation[1], 0);
    EXPECT_EQ(state.base.pose_covariance[28], Tuning::kPlanarVariance);
  } else {
    EXPECT_EQ(state.base.pose_odom.orientation, state.base.attitude);
    EXPECT_NEAR(state.base.pose_covariance[28], state.base.attitude_covariance[4], 1e-15);
  }
}

INSTANTIATE_TEST_SUITE_P(Planar, EstimatorPlaneTest, testing::Bool(), [](const testing::TestParamInfo<bool>& planar) {
  return planar.param ? "Projected" : "InThreeDimensions";
});

}  // namespace robot_control::tests
