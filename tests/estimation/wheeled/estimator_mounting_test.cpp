// Any mounting of the IMU is as good as an aligned one, and samples may come at any rate.

#include <cstring>

#include "estimation/wheeled/estimator_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

/// Stands and drives for ten seconds. `biased`: constant errors in base axes, wherever the IMU is.
StateFrame drive_with(const DriveTrain& model, RollingRobot& robot) {
  Estimator estimator(rigid_tyres(), model, kPeriod);
  StateFrame state;
  for (int i = 0; i < 10000; ++i) {
    robot.drive(i < 2000 ? 0 : 0.5, i < 2000 ? 0 : 0.6 * std::sin(i * 1e-3));
    estimator.step(robot.frame(), state);
  }
  return state;
}

DriveTrain mounted(const Eigen::Quaterniond& q, const Vector3& position) {
  DriveTrain model = two_wheeler();
  model.imu_in_base.orientation = {q.x(), q.y(), q.z(), q.w()};
  model.imu_in_base.position = position;
  return model;
}

class EstimatorMountingTest : public testing::TestWithParam<unsigned> {};

// The same samples in other axes give the same state up to rounding; biases are published in the IMU's own axes.
TEST_P(EstimatorMountingTest, AnyOrientationGivesTheSameState) {
  std::mt19937 random(GetParam());
  std::normal_distribution<double> normal(0, 1);
  Eigen::Quaterniond q{normal(random), normal(random), normal(random), normal(random)};
  q.normalize();
  if (GetParam() == 0) q = Eigen::Quaterniond(0, 1, 0, 0);  // upside-down
  const Eigen::Vector3d gyro_bias{0.002, -0.003, 0.0017};
  const Eigen::Vector3d accelerometer_bias{0.05, -0.02, 0.1};
  RollingRobot aligned(mounted(Eigen::Quaterniond::Identity(), {0.1, -0.05, 0.2}));
  aligned.gyro_bias = gyro_bias;
  aligned.accelerometer_bias = accelerometer_bias;
  RollingRobot turned(mounted(q, {0.1, -0.05, 0.2}));
  turned.gyro_bias = q.conjugate() * gyro_bias;
  turned.accelerometer_bias = q.conjugate() * accelerometer_bias;
  const StateFrame expected = drive_with(mounted(Eigen::Quaterniond::Identity(), {0.1, -0.05, 0.2}), aligned);
  const StateFrame state = drive_with(mounted(q, {0.1, -0.05, 0.2}), turned);
  constexpr double kRounding = 1e-8;  // of 10⁴ cycles
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_NEAR(state.base.pose_odom.position[i], expected.base.pose_odom.position[i], kRounding);
    EXPECT_NEAR(state.base.twist_base.linear[i], expected.base.twist_base.linear[i], kRounding);
  }
  EXPECT_NEAR(yaw_of(state.base.pose_odom), yaw_of(expected.base.pose_odom), kRounding);
  EXPECT_NEAR(state.base.pose_covariance[0], expected.base.pose_covariance[0], 1e-5 * expected.base.pose_covariance[0]);
  EXPECT_EQ(state.wheeled.slip, 0u);
  const Eigen::Vector3d in_imu(state.base.gyro_bias.data());
  const Eigen::Vector3d in_base(expected.base.gyro_bias.data());
  EXPECT_LT((q * in_imu - in_base).norm(), kRounding);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EstimatorMountingTest, testing::Range(0U, 10U));

// The effect of the lever on the accelerometer is known at any place.
TEST(EstimatorMounting, AnyPlaceFindsTheTruth) {
  for (const Vector3& place : {Vector3{0.3, 0.2, 0.5}, Vector3{-0.4, -0.3, 0.05}, Vector3{0, 0, 1}}) {
    const DriveTrain model = mounted(Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), place);
    RollingRobot robot(model);
    const StateFrame state = drive_with(model, robot);
    const double deviation = std::sqrt(state.base.pose_covariance[0] + state.base.pose_covariance[7]);
    EXPECT_LT(std::hypot(state.base.pose_odom.position[0] - robot.x(), state.base.pose_odom.position[1] - robot.y()),
              deviation);
    EXPECT_LT(std::abs(std::remainder(yaw_of(state.base.pose_odom) - robot.yaw(), 2 * std::numbers::pi)),
              std::sqrt(state.base.pose_covariance[35]));
    EXPECT_EQ(state.wheeled.slip, 0u);
  }
}

// Steps by cycle and by time are the same law with the same bits.
TEST(EstimatorRates, BothStepsAgree) {
  RollingRobot robot;
  robot.noise = {.gyro = 2.44e-4, .accelerometer = 2e-3, .counts = 4096};
  Estimator by_cycle(rigid_tyres(), two_wheeler(), kPeriod);
  Estimator by_time(rigid_tyres(), two_wheeler(), kPeriod);
  StateFrame one;
  StateFrame two;
  for (int i = 0; i < 5000; ++i) {
    robot.drive(i < 1000 ? 0 : 0.5, i < 1000 ? 0 : 0.3);
    by_cycle.step(robot.frame(), one);
    by_time.step(robot.frame(), kPeriod, two);
    one.skipped = two.skipped = 0;
    ASSERT_EQ(std::memcmp(&one, &two, sizeof one), 0) << "cycle " << i;
  }
}

/// Each sensor at its own rate: Hz, divisors of 1000.
struct Rates {
  int gyro, accelerometer, wheels;
};

class EstimatorRatesTest : public testing::TestWithParam<Rates> {};

// The pose is compared right after a reading of the wheels. A gyro at rate f misses less than α/(8 f²) rad per sample
// of a turn that changes by α rad/s². A late gyro sample turns the robot late by one gap.
TEST_P(EstimatorRatesTest, FindTheTruth) {
  RollingRobot robot;
  Estimator estimator(rigid_tyres(), two_wheeler(), kPeriod);
  StateFrame state;
  int flagged = 0;
  double since = 0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  int samples = 0;
  for (int i = 0; i <= 20000; ++i) {
    robot.drive(i < 3000 ? 0 : 0.5, i < 3000 ? 0 : 0.6 * std::sin(i * 5e-4));
    force += Eigen::Vector3d(robot.frame().imu.linear_acceleration.data());
    ++samples;
    since += kPeriod;
    SensorFrame frame = robot.frame();
    frame.valid = 0;
    if (i % (1000 / GetParam().gyro) == 0) frame.valid |= kValidGyro;
    const bool sampled = i % (1000 / GetParam().wheels) == 0;
    set_joints_valid(frame, sampled ? kValidMotion : 0);
    if (i % (1000 / GetParam().accelerometer) == 0) {  // a mean over the time before it
      frame.valid |= kValidAccelerometer;
      const Eigen::Vector3d mean = force / samples;
      frame.imu.linear_acceleration = {mean.x(), mean.y(), mean.z()};
      force.setZero();
      samples = 0;
    }
    if (frame.valid == 0 && !sampled) continue;
    estimator.step(frame, since, state);
    since = 0;
    if (i < 3000) continue;
    flagged += (state.base.flags & kStateSlip) != 0 ? 1 : 0;
    ASSERT_TRUE(all_finite(state)) << i;
    ASSERT_NE(state.base.flags & kStateValid, 0u) << i;
  }
  EXPECT_EQ(flagged, 0);
  const double gap = 1.0 / GetParam().gyro;
  EXPECT_LT(std::abs(yaw_of(state.base.pose_odom) - robot.yaw()), 0.6 * gap + 1e-3);
  EXPECT_LT(std::hypot(state.base.pose_odom.position[0] - robot.x(), state.base.pose_odom.position[1] - robot.y()),
            0.002 * robot.distance);
}

INSTANTIATE_TEST_SUITE_P(Rates, EstimatorRatesTest,
                         testing::Values(Rates{1000, 1000, 1000}, Rates{200, 100, 50}, Rates{100, 100, 20},
                                         Rates{50, 50, 25}, Rates{1000, 200, 40}),
                         [](const testing::TestParamInfo<Rates>& rates) {
                           return "Gyro" + std::to_string(rates.param.gyro) + "Accelerometer" +
                                  std::to_string(rates.param.accelerometer) + "Wheels" +
                                  std::to_string(rates.param.wheels);
                         });

}  // namespace robot_control::tests
