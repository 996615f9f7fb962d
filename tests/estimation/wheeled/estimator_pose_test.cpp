// The estimated pose against a truth in closed form, with ideal sensors.

#include <array>
#include <cstring>

#include "estimation/wheeled/estimator_fixture.h"
#include "support/allocation_guard.h"
#include "support/constants.h"
#include "support/matchers.h"

namespace robot_control::tests {

/// Ideal sensors leave at most two readings of an encoder, at either end of a way.
double reading() {
  return 2 * EstimatorParameters{}.encoder_noise * two_wheeler().wheels[0].radius;  // m
}
double reading_of_yaw() {
  return std::numbers::sqrt2 * reading() / two_wheeler().wheel_base;  // rad
}

constexpr double kExactVariance = 1e-18;  // m², rad²: rounding

struct EstimatorPoseTest : EstimatorFixture {
  EstimatorPoseTest() { stand(); }
  void expect_truth() const {
    EXPECT_LT(position_error(), reading());
    EXPECT_LT(yaw_error(), reading_of_yaw());
  }
};

class SteadyMotion : public EstimatorPoseTest, public testing::WithParamInterface<std::pair<double, double>> {};

TEST_P(SteadyMotion, PoseAndTwistAreTheTruth) {
  const auto [linear, angular] = GetParam();
  drive(linear, angular, 10000);
  expect_truth();
  EXPECT_NEAR(speed(), linear, std::sqrt(state_.base.twist_covariance[0]));
  EXPECT_NEAR(state_.base.twist_base.angular[2], angular, std::sqrt(state_.base.twist_covariance[35]));
  EXPECT_NEAR(state_.base.distance, robot_.distance, 0.001 * robot_.distance + reading());
  EXPECT_EQ(state_.base.flags, std::uint64_t{kStateValid});
  EXPECT_EQ(state_.wheeled.slip, 0u);
  for (const std::uint64_t rejected : state_.wheeled.rejected) EXPECT_EQ(rejected, 0u);
}

INSTANTIATE_TEST_SUITE_P(EstimatorPose, SteadyMotion,
                         testing::Values(std::pair{0.5, 0.0}, std::pair{0.5, 0.2}, std::pair{-0.5, 0.2},
                                         std::pair{-0.5, 0.0}, std::pair{0.0, 1.0}, std::pair{0.0, -1.0},
                                         std::pair{0.3, -2 * std::numbers::pi / 10}));

// x = −r sin … of a circle run at constant twist after a ramp: the truth itself against its closed form.
TEST_F(EstimatorPoseTest, AFullCircleEndsWhereItBegan) {
  const double rate = 2 * std::numbers::pi / 10;
  drive(0.3, rate, 1000);
  const double x0 = x();
  const double y0 = y();
  const double yaw0 = yaw();
  drive(0.3, rate, 10000);
  EXPECT_NEAR(x(), x0, 2 * reading());
  EXPECT_NEAR(y(), y0, 2 * reading());
  EXPECT_NEAR(std::remainder(yaw() - yaw0, 2 * std::numbers::pi), 0, 2 * reading_of_yaw());
}

// Rest is held until a wheel has left its tolerance; the motion in that window is then added at once.
TEST_F(EstimatorPoseTest, NothingOfAnEndedRestIsLost) {
  int waited = 0;
  while (x() == 0 && waited < 100) {
    drive(0.5, 0, 1);
    ++waited;
  }
  const double tolerance = EstimatorParameters{}.standstill_speed * EstimatorParameters{}.standstill_time * 0.1;
  EXPECT_NEAR(robot_.x(), tolerance, tolerance);  // one cycle after it was left, at the latest
  EXPECT_NEAR(x(), robot_.x(), 1e-12);
}

// An axle 0.2 m behind base_link: spinning moves base_link on a circle of that radius.
TEST(EstimatorPoseOfOtherRobots, ABaseBesideTheAxleMovesOnItsOwnCircle) {
  DriveTrain model = two_wheeler();
  model.wheels[0].centre_base[0] = model.wheels[1].centre_base[0] = -0.2;
  Estimator estimator(rigid_tyres(), model, kPeriod);
  RollingRobot robot(model);
  StateFrame state;
  for (int i = 0; i < 3000; ++i) {
    robot.drive(0, i < 500 ? 0 : 0.5);
    estimator.step(robot.frame(), state);
  }
  const double yaw = yaw_of(state.base.pose_odom);
  EXPECT_NEAR(yaw, 0.5 * 2.5 - 0.5 * 0.5 / RollingRobot::kTurnAcceleration / 2, reading_of_yaw());
  EXPECT_NEAR(state.base.pose_odom.position[0], -0.2 + 0.2 * std::cos(yaw), reading());
  EXPECT_NEAR(state.base.pose_odom.position[1], 0.2 * std::sin(yaw), reading());
  EXPECT_NEAR(state.base.twist_base.linear[1], 0.5 * 0.2, 1e-3);
}

TEST(EstimatorPoseOfOtherRobots, FourWheelsTurnAboutTheirMiddleByTheEffectiveWheelBase) {
  const DriveTrain model = four_wheeler();
  Estimator estimator(rigid_tyres(), model, kPeriod);
  RollingRobot robot(model);
  StateFrame state;
  for (int i = 0; i < 3000; ++i) {
    robot.drive(i < 500 ? 0 : 0.2, i < 500 ? 0 : 0.5);
    estimator.step(robot.frame(), state);
  }
  EXPECT_NEAR(yaw_of(state.base.pose_odom), robot.yaw(), reading_of_yaw());
  EXPECT_NEAR(state.base.pose_odom.position[0], robot.x(), reading());
  EXPECT_NEAR(state.base.pose_odom.position[1], robot.y(), reading());
  // Turning by the geometric wheel base would be 1.64 times as fast.
  EXPECT_NEAR(state.wheeled.odometry.yaw, robot.yaw(), 1e-9);
}

// The velocity is constant through a gap of eight cycles.
TEST_F(EstimatorPoseTest, SkippedCyclesAreTravelledAndCounted) {
  drive(0.5, 0.2, 1000);
  for (int i = 0; i < 8; ++i) robot_.drive(0.5, 0.2);
  observe();
  EXPECT_EQ(state_.skipped, 7u);
  EXPECT_TRUE(has(kStateSkipped));
  expect_truth();
  drive(0.5, 0.2, 1);
  EXPECT_EQ(state_.skipped, 7u);
  EXPECT_FALSE(has(kStateSkipped));
}

TEST_F(EstimatorPoseTest, AFrameSeenBeforeChangesNothing) {
  drive(0.5, 0.2, 100);
  const StateFrame before = state_;
  observe();
  EXPECT_EQ(std::memcmp(&before, &state_, sizeof before), 0);
  --robot_.frame().head.cycle;
  observe();
  EXPECT_EQ(std::memcmp(&before, &state_, sizeof before), 0) << "an older one neither";
}

TEST_F(EstimatorPoseTest, ResetPoseIsZeroInTheNextFrameAndKeepsTheTwist) {
  drive(0.5, 0.2, 1000);
  const double distance = state_.base.distance;
  estimator_.set_pose({0, 0, 0});
  drive(0.5, 0.2, 1);
  EXPECT_EQ(state_.base.pose_odom.position, (Vector3{0, 0, 0}));
  EXPECT_NEAR(yaw(), 0, 1e-15);
  for (const std::size_t i : {0U, 1U, 5U, 6U, 7U, 11U, 30U, 31U, 35U}) {
    EXPECT_NEAR(state_.base.pose_covariance[i], 0, kExactVariance) << i;
  }
  EXPECT_NEAR(speed(), 0.5, 1e-3);
  EXPECT_GT(state_.base.distance, distance);
}

// The IMU is high on a robot that may be tilted: its own place is uncertain, that of base_link is not.
TEST(EstimatorPoseOfOtherRobots, ResetPoseIsExactForBaseLinkUnderAnyImu) {
  DriveTrain model = two_wheeler();
  model.imu_in_base.position = {0.2, -0.1, 0.8};
  Estimator estimator(rigid_tyres(), model, kPeriod);
  RollingRobot robot(model);
  StateFrame state;
  for (int i = 0; i < 3000; ++i) {
    robot.drive(i < 500 ? 0 : 0.5, i < 500 ? 0 : 0.3, i < 2000 ? 0 : -0.05);  // onto a ramp of 0.05 rad
    if (i == 2999) estimator.set_pose({3, -4, 1});
    estimator.step(robot.frame(), state);
  }
  EXPECT_NEAR(state.base.pose_odom.position[0], 3, 1e-15);
  EXPECT_NEAR(state.base.pose_odom.position[1], -4, 1e-15);
  EXPECT_NEAR(yaw_of(state.base.pose_odom), 1, 1e-15);
  for (const std::size_t i : {0U, 1U, 5U, 6U, 7U, 11U, 30U, 31U, 35U}) {
    EXPECT_NEAR(state.base.pose_covariance[i], 0, kExactVariance) << i;
  }
}

// From (1, 2, 90°), ahead is y of odom.
TEST_F(EstimatorPoseTest, SetPoseContinuesFromThere) {
  drive(0.5, 0.2, 1000);
  drive(0.5, 0, 1000);
  estimator_.set_pose({1, 2, std::numbers::pi / 2});
  drive(0.5, 0, 1);
  EXPECT_NEAR(x(), 1, 1e-15);
  EXPECT_NEAR(y(), 2, 1e-15);
  EXPECT_NEAR(yaw(), std::numbers::pi / 2, 1e-15);
  drive(0.5, 0, 1000);
  EXPECT_NEAR(x(), 1, 2 * reading());
  EXPECT_NEAR(y(), 2.5, 2 * reading());
  EXPECT_GT(state_.base.pose_covariance[7], 0);
}

// The covariance of the calibration turns with the pose: from then on both drives give the same numbers.
TEST_F(EstimatorPoseTest, SetPoseIsTheSameDriveInOtherAxes) {
  drive(0.5, 0.2, 2000);
  Estimator turned = estimator_;
  const double angle = 2.0;
  estimator_.set_pose({0, 0, 0});
  turned.set_pose({0, 0, angle});
  StateFrame other;
  for (int i = 0; i < 3000; ++i) {
    robot_.drive(0.3, -0.4);
    observe();
    turned.step(robot_.frame(), other);
  }
  constexpr double kRounding = 1e-9;            // of 15 000 updates of numbers of order 1
  constexpr double kCovarianceRounding = 1e-6;  // relative
  EXPECT_NEAR(std::cos(angle) * x() - std::sin(angle) * y(), other.base.pose_odom.position[0], kRounding);
  EXPECT_NEAR(std::sin(angle) * x() + std::cos(angle) * y(), other.base.pose_odom.position[1], kRounding);
  EXPECT_NEAR(std::remainder(yaw() + angle - yaw_of(other.base.pose_odom), 2 * std::numbers::pi), 0, kRounding);
  EXPECT_NEAR(state_.base.pose_covariance[0] + state_.base.pose_covariance[7],
              other.base.pose_covariance[0] + other.base.pose_covariance[7],
              kCovarianceRounding * state_.base.pose_covariance[0]);
  EXPECT_NEAR(state_.base.pose_covariance[35], other.base.pose_covariance[35],
              kCovarianceRounding * state_.base.pose_covariance[35]);
}

TEST_F(EstimatorPoseTest, ARestartContinuesWithoutAJumpAndWithGrownCovariance) {
  drive(0.5, 0.2, 2000);
  StateFrame last = state_;
  last.head.cycle = robot_.frame().head.cycle;
  Estimator restarted(rigid_tyres(), two_wheeler(), kPeriod);
  restarted.resume(last);
  for (int i = 0; i < 300; ++i) robot_.drive(0.5, 0.2);
  restarted.step(robot_.frame(), state_);
  for (const std::size_t i : {0U, 1U, 2U}) {
    EXPECT_NEAR(state_.base.pose_odom.position[i], last.base.pose_odom.position[i], 1e-15);
  }
  EXPECT_NEAR(yaw(), yaw_of(last.base.pose_odom), 1e-15);
  EXPECT_EQ(state_.base.distance, last.base.distance);
  EXPECT_EQ(state_.skipped, last.skipped + 299);
  EXPECT_TRUE(has(kStateRestarted));
  EXPECT_TRUE(has(kStateValid));
  EXPECT_EQ(state_.base.gyro_bias, last.base.gyro_bias);
  EXPECT_NEAR(state_.wheeled.calibration.radius_ratio, last.wheeled.calibration.radius_ratio, 1e-15);
  // The unknown travel is about 0.5 m/s · 0.3 s.
  EXPECT_GT(state_.base.pose_covariance[0], last.base.pose_covariance[0] + 0.14 * 0.14);
  EXPECT_GT(state_.base.pose_covariance[35], last.base.pose_covariance[35] + 0.05 * 0.05);
  EXPECT_NEAR(speed(), last.base.twist_base.linear[0], 1e-12);
  const double x0 = x();
  const double y0 = y();
  for (int i = 0; i < 1000; ++i) {
    robot_.drive(0.5, 0.2);
    restarted.step(robot_.frame(), state_);
  }
  const double chord = 2 * 0.5 / 0.2 * std::sin(0.2 / 2);
  EXPECT_NEAR(std::hypot(x() - x0, y() - y0), chord, 1e-3);
  EXPECT_TRUE(has(kStateRestarted));
}

TEST_F(EstimatorPoseTest, ARestartInTheCycleAlreadyPublishedHoldsThePose) {
  drive(0.5, 0.2, 500);
  StateFrame last = state_;
  last.head.cycle = robot_.frame().head.cycle;
  Estimator restarted(rigid_tyres(), two_wheeler(), kPeriod);
  restarted.resume(last);
  restarted.step(robot_.frame(), state_);
  EXPECT_NEAR(x(), last.base.pose_odom.position[0], 1e-15);
  EXPECT_EQ(state_.skipped, last.skipped);
}

TEST_F(EstimatorPoseTest, ALastFrameThatIsNotFiniteIsNotContinuedFrom) {
  drive(0.5, 0.2, 100);
  const auto spoil = [&](auto fault) {
    StateFrame last = state_;
    last.head.cycle = robot_.frame().head.cycle;
    fault(last);
    Estimator restarted(rigid_tyres(), two_wheeler(), kPeriod);
    restarted.resume(last);
    StateFrame state;
    restarted.step(robot_.frame(), state);
    EXPECT_EQ(state.base.pose_odom.position, (Vector3{0, 0, 0}));
    EXPECT_EQ(state.base.flags & kStateRestarted, 0u);
    EXPECT_TRUE(all_finite(state));
  };
  spoil([](StateFrame& last) { last.base.pose_odom.position[0] = std::nan(""); });
  spoil([](StateFrame& last) { last.base.pose_covariance[7] = HUGE_VAL; });
  spoil([](StateFrame& last) { last.wheeled.calibration.radius_ratio = std::nan(""); });
  spoil([](StateFrame& last) { last.base.attitude = {0, 0, 0, 0}; });
  spoil([](StateFrame& last) { last.base.flags = 0; });
}

TEST_F(EstimatorPoseTest, CovarianceGrowsWithDistanceAndWithTurn) {
  drive(0.5, 0, 2000);
  const double position = state_.base.pose_covariance[0];
  const double yaw = state_.base.pose_covariance[35];
  EXPECT_GT(position, 0);
  drive(0.5, 0, 2000);
  const double noise = EstimatorParameters{}.wheel_slip_noise;
  EXPECT_GT(state_.base.pose_covariance[0], position + 0.9 * noise * noise / 2 * 1.0);  // m: two wheels' mean
  const double yaw_straight = state_.base.pose_covariance[35];
  EXPECT_GT(yaw_straight, yaw);
  drive(0, 1.0, 1000);
  EXPECT_GT(state_.base.pose_covariance[35], yaw_straight);
}

// The mean of two independent wheels has σ² after d metres of wheel_slip_noise² · d / 2. It holds once the residuals of
// a perfect floor have reduced the learned slip noise to that lower bound. The comparison is at rest, where the clock
// offset does not matter.
TEST_F(EstimatorPoseTest, DistanceVarianceIsThatOfTwoIndependentWheels) {
  drive(0.5, 0, 200000);
  drive(0, 0, 3000);
  const auto variance = [&] {  // without what an uncertain heading shortens
    const double shortened = (1 - std::cos(std::sqrt(state_.base.pose_covariance[35]))) * x();
    return state_.base.pose_covariance[0] - shortened * shortened;
  };
  const double before = variance();
  const double distance = robot_.distance;
  drive(0.5, 0, 20000);
  drive(0, 0, 3000);
  const double noise = EstimatorParameters{}.wheel_slip_noise;
  const double distance_driven = robot_.distance - distance;
  const double radius = EstimatorParameters{}.wheel_radius_deviation;
  const double scaled = radius * radius * (robot_.distance * robot_.distance - distance * distance);
  const double expected = noise * noise / 2 * distance_driven;
  EXPECT_NEAR(variance() - before - scaled, expected, 0.02 * expected + 1e-6 * scaled);
}

TEST_F(EstimatorPoseTest, CovariancesAreSymmetricAndPositive) {
  for (int leg = 0; leg < 20; ++leg) {
    drive(0.5 - 0.05 * leg, 0.3 * std::sin(leg), 500);
    for (const Matrix6& published : {state_.base.pose_covariance, state_.base.twist_covariance}) {
      const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> matrix(published.data());
      const Eigen::Matrix<double, 6, 1> scale = matrix.diagonal().cwiseSqrt();
      const Eigen::Matrix<double, 6, 6> skew = matrix - matrix.transpose();
      EXPECT_LT((skew.array() / (scale * scale.transpose()).array()).abs().maxCoeff(), 1e-12) << "leg " << leg;
      EXPECT_TRUE(is_covariance(published, 0)) << "leg " << leg;
    }
  }
}

// Late wheels leave the position behind, a late gyro the yaw. Nothing has shown yet which of them is late.
TEST_F(EstimatorPoseTest, AClockOffsetThatIsNotKnownMayBeThatOfEitherSensor) {
  constexpr std::size_t kLate = 50;         // cycles
  constexpr double kAlmostCertain = 16.27;  // 99.9 % of χ² with 3 degrees of freedom
  for (const bool gyro_is_late : {true, false}) {
    RollingRobot robot;
    Estimator estimator(rigid_tyres(), two_wheeler(), kPeriod);
    std::vector<SensorFrame> frames;
    for (int i = 0; i < 900; ++i) {
      robot.drive(0.5, 0.8);
      frames.push_back(robot.frame());
      SensorFrame frame = robot.frame();
      const SensorFrame& earlier = frames[frames.size() > kLate ? frames.size() - kLate : 0];
      if (gyro_is_late) {
        frame.imu = earlier.imu;
      } else {
        frame.joints = earlier.joints;
      }
      estimator.step(frame, state_);
    }
    const Eigen::Vector3d error(x() - robot.x(), y() - robot.y(), yaw() - robot.yaw());
    const std::array<int, 3> plane{0, 1, 5};
    const Eigen::Matrix3d covariance =
        Eigen::Map<const Eigen::Matrix<double, 6, 6>>(state_.base.pose_covariance.data())(plane, plane);
    EXPECT_LT(error.dot(covariance.inverse() * error), kAlmostCertain) << "late gyro: " << gyro_is_late;
  }
}

TEST_F(EstimatorPoseTest, StepsWithoutAllocating) {
  const AllocationGuard guard;
  for (int i = 0; i < 3000; ++i) {
    robot_.drive(i < 1500 ? 0.5 : 0, i < 1000 ? 0.2 : 0);
    if (i == 600) robot_.tread[0] = 2.0;  // spins
    if (i == 1200) robot_.tread[0].reset();
    if (i == 300) robot_.frame().imu.angular_velocity[2] = std::nan("");
    if (i == 400) estimator_.set_pose({0, 0, 0});
    if (i == 2500) estimator_.resume(state_);
    if (i == 2800) estimator_.enter_run();
    observe();
  }
  EXPECT_EQ(guard.count(), 0u);
}

static_assert(noexcept(std::declval<Estimator>().step(SensorFrame{}, std::declval<StateFrame&>())));
static_assert(noexcept(std::declval<Estimator>().step(SensorFrame{}, 1e-3, std::declval<StateFrame&>())));

TEST(EstimatorConstruction, RefusesWhatCannotBe) {
  const DriveTrain robot = two_wheeler();
  EXPECT_THROW(Estimator(EstimatorParameters{}, robot, 0), std::invalid_argument);
  EXPECT_THROW(Estimator(EstimatorParameters{}, robot, std::nan("")), std::invalid_argument);
  const auto refuses_robot = [&](auto fault) {
    DriveTrain broken = robot;
    fault(broken);
    EXPECT_THROW(Estimator(EstimatorParameters{}, broken, kPeriod), std::invalid_argument);
  };
  refuses_robot([](DriveTrain& broken) { broken.wheel_base = 0; });
  refuses_robot([](DriveTrain& broken) { broken.wheels.pop_back(); });
  refuses_robot([](DriveTrain& broken) { broken.wheels[0].radius = -0.1; });
  refuses_robot([](DriveTrain& broken) { broken.imu_in_base.orientation = {0, 0, 0, 0}; });
  using Parameters = EstimatorParameters;
  for (double Parameters::*const positive :
       {&Parameters::gyro_noise, &Parameters::accelerometer_noise, &Parameters::encoder_noise,
        &Parameters::standstill_speed, &Parameters::standstill_time, &Parameters::speed_bandwidth,
        &Parameters::rate_bandwidth}) {
    for (const double value : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
      Parameters parameters;
      parameters.*positive = value;
      EXPECT_THROW(Estimator(parameters, robot, kPeriod), std::invalid_argument) << value;
    }
  }
  for (double Parameters::*const no_less :
       {&Parameters::wheel_slip_noise, &Parameters::tyre_creep, &Parameters::gyro_scale_deviation,
        &Parameters::gyro_bias_initial, &Parameters::gyro_bias_walk, &Parameters::accelerometer_bias_initial,
        &Parameters::accelerometer_bias_walk}) {
    for (const double value : {-1.0, std::nan(""), HUGE_VAL}) {
      Parameters parameters;
      parameters.*no_less = value;
      EXPECT_THROW(Estimator(parameters, robot, kPeriod), std::invalid_argument) << value;
    }
  }
}

TEST(EstimatorConstruction, NamesWhatIsWrongItsRuleAndItsValue) {
  EXPECT_THAT(
      [] { Estimator({.gyro_noise = -0.5}, two_wheeler(), kPeriod); },
      ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("gyro_noise must be > 0 rad/s/√Hz"), HasSubstr("-0.5"))));
}

}  // namespace robot_control::tests
