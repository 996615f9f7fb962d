// Samples are missing, not finite or impossible, and sensors are lost.

#include "estimation/wheeled/estimator_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

constexpr double kExact = 1e-4;  // m: two readings of an encoder

/// Healthy case: a second of standing, then 0.5 m/s straight ahead.
struct EstimatorFaultsTest : EstimatorFixture {
  EstimatorFaultsTest() {
    stand();
    drive(0.5, 0, 1500);
  }
  void lose(std::uint64_t bits) { robot_.frame().valid &= ~bits; }
};

TEST_F(EstimatorFaultsTest, AMissingReadingOfOneEncoderDoesNotHoldThePoseBack) {
  for (const double value : {kNaN, kInfinity, -kInfinity, 1e300}) {
    broken([&](SensorFrame& frame) { frame.joints[1].position = value; });
    EXPECT_TRUE(has(kStateBadSample)) << value;
    EXPECT_TRUE(has(kStateNoRightEncoder)) << value;
    EXPECT_FALSE(has(kStateNoLeftEncoder)) << value;
    EXPECT_TRUE(has(kStateValid)) << value;
    EXPECT_EQ(state_.wheeled.confidence[kRightEncoder], 0) << value;
    EXPECT_LT(position_error(), kExact) << value;
  }
  drive(0.5, 0, 1);
  EXPECT_EQ(state_.base.flags, std::uint64_t{kStateValid});
  EXPECT_LT(position_error(), kExact);
}

TEST_F(EstimatorFaultsTest, EncodersMissingForLongAreNoValidState) {
  const auto silence = [](SensorFrame& frame) { set_joints_valid(frame, 0); };
  for (std::uint64_t i = 0; i < Tuning::kMaxHeld; ++i) {
    broken(silence);
    EXPECT_TRUE(has(kStateValid)) << i;
  }
  broken(silence);
  EXPECT_FALSE(has(kStateValid));
  drive(0.5, 0, 1);
  EXPECT_TRUE(has(kStateValid));
}

// Nothing shows the speed, so the pose stays and the twist is zero. The deviation of the speed is the last one, and
// that of the position grows by it.
TEST_F(EstimatorFaultsTest, TwistAndPoseAgreeWithoutAnEncoderAndTheirDeviationsGrow) {
  set_joints_valid(robot_.frame(), 0);
  drive(0.5, 0, 10);
  const StateFrame lost = state_;
  double before = 0;
  for (int i = 0; i < 100; ++i) {
    drive(0.5, 0, 100);
    EXPECT_EQ(x(), lost.base.pose_odom.position[0]);
    EXPECT_EQ(speed(), 0);
    EXPECT_NEAR(std::sqrt(state_.base.twist_covariance[0]), 0.5, 0.01);
    const double deviation = std::sqrt(state_.base.pose_covariance[0]);
    EXPECT_NEAR(deviation - before, 0.5 * 0.1, i == 0 ? 0.05 : 0.001) << i;
    EXPECT_LT(std::abs(x() - robot_.x()), 2 * deviation);
    before = deviation;
  }
  EXPECT_TRUE(all_finite(state_));
  EXPECT_TRUE(is_covariance(state_.base.pose_covariance, 1e-9));
}

// The other wheel shows nothing of a side that is lost, unless the gyro shows the turn.
TEST_F(EstimatorFaultsTest, TwistAndPoseAgreeWithoutOneEncoderAndTheGyro) {
  lose(kValidGyro);
  for (int i = 0; i < 300; ++i) broken([](SensorFrame& frame) { frame.joints[0].position = kNaN; });
  const double begin_yaw = yaw();
  double turned = 0;
  for (int i = 0; i < 300; ++i) {
    broken([](SensorFrame& frame) { frame.joints[0].position = kNaN; });
    turned += state_.base.twist_base.angular[2] * kPeriod;
  }
  EXPECT_NEAR(yaw() - begin_yaw, turned, 0.01 * std::abs(turned) + 1.0e-3);
  EXPECT_GT(std::sqrt(state_.base.twist_covariance[35]), 0.9);  // rad/s: one side has 0.5 m/s or none
}

// Both are missing for two seconds: the next good reading brings the whole travel.
TEST_F(EstimatorFaultsTest, EncodersThatComeBackBringTheWholeTravel) {
  set_joints_valid(robot_.frame(), 0);
  drive(0.5, 0, 2000);
  EXPECT_FALSE(has(kStateValid));
  EXPECT_TRUE(all_finite(state_));
  set_joints_valid(robot_.frame(), kValidMotion);
  drive(0.5, 0, 500);
  EXPECT_TRUE(has(kStateValid));
  EXPECT_LT(position_error(), 0.01);
}

TEST_F(EstimatorFaultsTest, NoEncoderEverIsNoValidState) {
  Estimator estimator(rigid_tyres(), two_wheeler(), kPeriod);
  RollingRobot robot;
  robot.frame().joint_count = 0;
  for (int i = 0; i < 100; ++i) {
    robot.drive(0.5, 0);
    estimator.step(robot.frame(), state_);
  }
  EXPECT_FALSE(has(kStateValid));
  EXPECT_TRUE(has(kStateNoLeftEncoder));
  EXPECT_TRUE(has(kStateNoRightEncoder));
  EXPECT_TRUE(all_finite(state_));
}

TEST_F(EstimatorFaultsTest, EncodersThatBeganAnewCostCovarianceNotAJump) {
  const double variance = state_.base.pose_covariance[0];
  for (std::uint64_t i = 0; i <= Tuning::kMaxHeld; ++i) {
    broken([](SensorFrame& frame) {
      frame.joints[0].position -= 500;
      frame.joints[1].position -= 500;
    });
    EXPECT_LT(position_error(), Tuning::kRestart) << i;  // a jump would be 50 m
  }
  EXPECT_GT(state_.base.pose_covariance[0], variance);
  EXPECT_TRUE(has(kStateEncoderRestarted));
  for (int i = 0; i < 500; ++i) {
    broken([](SensorFrame& frame) {
      frame.joints[0].position -= 500;
      frame.joints[1].position -= 500;
    });
  }
  EXPECT_EQ(state_.base.flags, std::uint64_t{kStateValid});
  EXPECT_LT(position_error(), Tuning::kRestart);
}

// The gyro alone turns it: the bias of a rest of one second is known to 2.44e-4 rad/s.
TEST_F(EstimatorFaultsTest, OneEncoderAndTheGyroCarryOn) {
  for (int i = 0; i < 10000; ++i) {
    robot_.drive(0.5, 0.2 * std::sin(i * 1e-3));
    SensorFrame frame = robot_.frame();
    frame.joints[1].position = kNaN;
    estimator_.step(frame, state_);
    ASSERT_TRUE(has(kStateValid)) << i;
    ASSERT_TRUE(has(kStateNoRightEncoder)) << i;
    ASSERT_TRUE(all_finite(state_)) << i;
  }
  EXPECT_LT(yaw_error(), 1e-3);
  EXPECT_LT(position_error(), 0.005);  // 0.1 % of 5 m
  EXPECT_EQ(state_.wheeled.confidence[kRightEncoder], 0);
  EXPECT_EQ(state_.wheeled.slip, 0u);
}

TEST_F(EstimatorFaultsTest, OneEncoderWithoutGyroIsNoValidState) {
  lose(kValidGyro);
  for (int i = 0; i < 100; ++i) broken([](SensorFrame& frame) { frame.joints[0].position = kNaN; });
  EXPECT_TRUE(has(kStateNoGyro));
  EXPECT_TRUE(has(kStateNoLeftEncoder));
  EXPECT_FALSE(has(kStateValid));
  EXPECT_TRUE(all_finite(state_));
}

TEST_F(EstimatorFaultsTest, TheWheelsTurnAloneWithoutGyro) {
  lose(kValidGyro);
  for (int i = 0; i < 5000; ++i) {
    robot_.drive(0.5, 0.2);
    robot_.frame().imu.angular_velocity = {0, 0, kNaN};
    observe();
    ASSERT_FALSE(has(kStateBadSample)) << "it was not offered";
  }
  EXPECT_TRUE(has(kStateNoGyro));
  EXPECT_TRUE(has(kStateValid));
  EXPECT_LT(yaw_error(), std::sqrt(state_.base.pose_covariance[35]));
  EXPECT_LT(position_error(), std::sqrt(state_.base.pose_covariance[0] + state_.base.pose_covariance[7]));
  EXPECT_EQ(state_.wheeled.confidence[kGyro], 0);
  EXPECT_GT(state_.wheeled.confidence[kLeftEncoder], 0.9);
  EXPECT_NEAR(state_.base.twist_base.angular[2], 0.2, 1e-3);
  EXPECT_EQ(state_.wheeled.slip, 0u);
}

TEST_F(EstimatorFaultsTest, ABadGyroSampleIsHeldOver) {
  for (const double value : {kNaN, kInfinity, 1e9}) {
    broken([&](SensorFrame& frame) { frame.imu.angular_velocity[1] = value; });
    EXPECT_TRUE(has(kStateBadSample));
    EXPECT_FALSE(has(kStateNoGyro));
    drive(0.5, 0, 1);
    EXPECT_EQ(state_.base.flags, std::uint64_t{kStateValid});
  }
  EXPECT_LT(yaw_error(), 1e-9);
}

TEST_F(EstimatorFaultsTest, ABadAccelerometerSampleIsHeldOver) {
  broken([](SensorFrame& frame) { frame.imu.linear_acceleration = {kNaN, kInfinity, 1e308}; });
  EXPECT_TRUE(has(kStateBadSample));
  EXPECT_FALSE(has(kStateNoAccelerometer));
  EXPECT_TRUE(has(kStateValid));
  drive(0.5, 0, 1);
  EXPECT_EQ(state_.base.flags, std::uint64_t{kStateValid});
  EXPECT_LT(position_error(), kExact);
}

TEST_F(EstimatorFaultsTest, WheelsAndGyroCarryOnWithoutAccelerometer) {
  lose(kValidAccelerometer);
  drive(0.5, 0.2, 5000);
  EXPECT_TRUE(has(kStateNoAccelerometer));
  EXPECT_TRUE(has(kStateValid));
  EXPECT_EQ(state_.wheeled.confidence[kAccelerometer], 0);
  EXPECT_LT(position_error(), 1e-3);
  EXPECT_LT(yaw_error(), 1e-3);
}

TEST_F(EstimatorFaultsTest, IsTheOdometryOfTheWheelsWithThemAlone) {
  lose(kValidAccelerometer | kValidGyro);
  drive(0.5, 0.2, 5000);
  EXPECT_TRUE(has(kStateValid));
  EXPECT_LT(yaw_error(), std::sqrt(state_.base.pose_covariance[35]));
  EXPECT_LT(position_error(), std::sqrt(state_.base.pose_covariance[0] + state_.base.pose_covariance[7]));
  // The bound holds 3 % of an uncertain wheel base and 1 % of the radius ratio over 2.5 m. No gyro watches the wheels,
  // so their first noise counts twice: 0.05 rad/√rad over 1 rad, and 5 mm/√m of either side.
  EXPECT_LT(std::sqrt(state_.base.pose_covariance[35]), std::hypot(0.03, 0.05, std::hypot(0.1, 0.045)) * 1.01);
}

TEST_F(EstimatorFaultsTest, NothingAtAllIsFlagged) {
  lose(kValidAccelerometer | kValidGyro);
  set_joints_valid(robot_.frame(), 0);
  drive(0.5, 0.2, 60000);
  EXPECT_FALSE(has(kStateValid));
  for (const StateFlag flag :
       {kStateNoGyro, kStateNoAccelerometer, kStateNoLeftEncoder, kStateNoRightEncoder, kStateBadSample}) {
    EXPECT_TRUE(has(flag));
  }
  EXPECT_TRUE(all_finite(state_));
  robot_.frame().valid |= kValidAccelerometer | kValidGyro;
  set_joints_valid(robot_.frame(), kValidMotion);
  drive(0, 0, 3000);
  EXPECT_TRUE(has(kStateValid));
  EXPECT_NEAR(speed(), 0, 0.01);
}

/// 100 000 frames with arbitrary content.
class EstimatorGarbageTest : public EstimatorFixture, public testing::WithParamInterface<unsigned> {};

TEST_P(EstimatorGarbageTest, NeverPoisonsTheState) {
  const double garbage[] = {kNaN, kInfinity, -kInfinity, 1e308, -1e308, 1e-320, 0.0, 5.0, 99.0, -999.0, 0.3};
  std::mt19937 random(GetParam());
  const auto pick = [&] { return garbage[random() % std::size(garbage)]; };
  stand();
  double distance = state_.base.distance;
  for (int i = 0; i < 10000; ++i) {
    const double linear = i % 2000 < 1000 ? 0.5 : 0;
    robot_.drive(linear, 0.2);
    SensorFrame frame = robot_.frame();
    if (random() % 2 == 0) {
      if (random() % 2 == 0) frame.valid = random();
      if (random() % 4 == 0) frame.joint_count = random() % 40;
      if (random() % 8 == 0) frame.head.cycle += random() % 3;
      if (random() % 2 == 0) {
        frame.joints[0] = {.position = pick(), .velocity = pick(), .effort = pick(), .temperature = pick()};
        frame.joints[0].age_ns = static_cast<std::int64_t>(random());
        frame.joints[0].valid = static_cast<std::uint32_t>(random());
      }
      if (random() % 2 == 0) frame.joints[1].position = pick();
      if (random() % 2 == 0) frame.imu.angular_velocity = {pick(), pick(), pick()};
      if (random() % 2 == 0) frame.imu.linear_acceleration = {pick(), pick(), pick()};
      if (random() % 500 == 0) estimator_.set_pose({1, 2, 3});
    }
    if (random() % 3 == 0) {
      estimator_.step(frame, static_cast<double>(1 + random() % 50) * 1e-3, state_);
    } else {
      estimator_.step(frame, state_);
    }
    ASSERT_TRUE(all_finite(state_)) << "cycle " << i;
    ASSERT_GE(state_.base.distance, distance) << "cycle " << i;
    distance = state_.base.distance;
    for (const Matrix6& published : {state_.base.pose_covariance, state_.base.twist_covariance}) {
      for (std::size_t k = 0; k < 6; ++k) ASSERT_GE(published[7 * k], 0) << "cycle " << i;
      // 2000 steps of 10⁻¹⁶, and gains of 10⁵ from garbage
      if (i % 100 == 0) {
        ASSERT_TRUE(is_covariance(published, 1e-8)) << "cycle " << i;
      }
    }
  }
  robot_.frame().head.cycle += 10;
  // If the gyro's bias is wrong, it recovers after Tuning::kConstantRate; a stop and two windows take as long again.
  drive(0, 0, static_cast<int>(2 * Tuning::kConstantRate / kPeriod));
  EXPECT_TRUE(has(kStateValid));
  EXPECT_TRUE(has(kStateStandstill));
  EXPECT_EQ(state_.wheeled.slip, 0u);
  EXPECT_EQ(speed(), 0);
  estimator_.set_pose({0, 0, 0});  // the pose of before is worth nothing
  drive(0.5, 0, 2000);
  EXPECT_TRUE(has(kStateValid));
  drive(0, 0, static_cast<int>(2 * Tuning::kConstantRate / kPeriod));
  EXPECT_TRUE(has(kStateStandstill));
  EXPECT_EQ(speed(), 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EstimatorGarbageTest, testing::Range(0U, 10U));

// Either sensor may have failed: the deviation of the heading is the difference, and shrinks while both agree. Wheels
// that are dragged may turn the robot by less than their own turn, so that the gyro has to lie for a whole block.
class ALyingGyro : public EstimatorFixture, public testing::WithParamInterface<double> {};

TEST_P(ALyingGyro, WidensTheHeading) {
  robot_.noise = {.gyro = 1e-4, .accelerometer = 1e-3, .counts = 4096};
  stand(3000);
  drive(0.5, 0.3, 6000);
  for (int i = 0; i < GetParam() / kPeriod; ++i) {
    broken([](SensorFrame& frame) { frame.imu.angular_velocity[2] = -frame.imu.angular_velocity[2]; });
  }
  EXPECT_TRUE(has(kStateDegraded));
  drive(0.5, 0.3, 2000);
  stand(3000);
  const double off = yaw_error();
  EXPECT_GT(off, 0.2);
  EXPECT_LT(off, 4 * std::sqrt(state_.base.pose_covariance[35]));
  EXPECT_LT(off, 1.1 * 2 * 0.3 * GetParam());
}

INSTANTIATE_TEST_SUITE_P(Seconds, ALyingGyro, testing::Values(2.0, 3.0));

}  // namespace robot_control::tests
