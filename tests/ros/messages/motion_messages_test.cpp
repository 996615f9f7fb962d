#include "ros/messages/motion_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace robot_control::tests {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

struct MotionMessagesTest : testing::Test {
  MotionMessagesTest() {
    robot_.base_link = "base_link";
    robot_.imu_link = "imu_link";
    robot_.joints.resize(3);
    robot_.joints[0].name = "left";
    robot_.joints[1].name = "right";
    robot_.joints[2].name = "mast";
    sensors_.joint_count = 3;
    set_joints_valid(sensors_, kValidMotion);
    sensors_.valid = kValidGyro | kValidAccelerometer;
  }

  const ros::Time stamp_{12, 34};
  MachineModel robot_;
  SensorFrame sensors_;
  StateFrame state_;
  CommandFrame command_;
};

TEST_F(MotionMessagesTest, JointStatesCarryEveryJointInFrameOrder) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = static_cast<double>(i);
    sensors_.joints[i] = {.position = 1 + value, .velocity = 10 + value, .effort = 100 + value};
  }
  const sensor_msgs::JointState message = joint_states(sensors_, nullptr, robot_, stamp_);
  EXPECT_THAT(message.name, ElementsAre("left", "right", "mast"));
  EXPECT_THAT(message.position, ElementsAre(1, 2, 3));
  EXPECT_THAT(message.velocity, ElementsAre(10, 11, 12));
  EXPECT_THAT(message.effort, ElementsAre(100, 101, 102));
  EXPECT_EQ(message.header.stamp, stamp_);
}

// The speed that an encoder reports jumps by a count per period.
TEST_F(MotionMessagesTest, JointStatesCarryTheWheelsTrackedVelocities) {
  for (std::size_t i = 0; i < 3; ++i) sensors_.joints[i].velocity = 4.60;
  state_.joint_velocity = {4.5, 5.5, 7};
  EXPECT_THAT(joint_states(sensors_, &state_, robot_, stamp_).velocity, ElementsAre(4.5, 5.5, 7));
}

TEST_F(MotionMessagesTest, ABatteryThatGivesCurrentDischargesAndWhatIsNotMeasuredIsUnknown) {
  sensors_.battery_voltage = 23.5;
  sensors_.battery_current = 2;
  const sensor_msgs::BatteryState message = battery_state(sensors_, stamp_);
  EXPECT_EQ(message.header.stamp, stamp_);
  EXPECT_EQ(message.voltage, 23.5F);
  EXPECT_EQ(message.current, -2.0F);
  EXPECT_EQ(message.power_supply_status, sensor_msgs::BatteryState::POWER_SUPPLY_STATUS_DISCHARGING);
  EXPECT_EQ(message.present, 1);
  for (const float value : {message.temperature, message.charge, message.capacity, message.percentage}) {
    EXPECT_TRUE(std::isnan(value));
  }
}

TEST_F(MotionMessagesTest, OdometryCarriesBothCovariancesAndBothFrames) {
  state_.base.pose_odom = {.position = {1, 2, 3}, .orientation = {0, 0, 0.6, 0.8}};
  state_.base.twist_base = {.linear = {4, 5, 6}, .angular = {7, 8, 9}};
  for (std::size_t i = 0; i < 36; ++i) {
    state_.base.pose_covariance[i] = static_cast<double>(i);
    state_.base.twist_covariance[i] = -static_cast<double>(i);
  }
  const nav_msgs::Odometry message = odometry(state_, "odom", "base_link", stamp_);
  EXPECT_EQ(message.header.frame_id, "odom");
  EXPECT_EQ(message.child_frame_id, "base_link");
  EXPECT_EQ(message.pose.pose.position.y, 2);
  EXPECT_EQ(message.pose.pose.orientation.z, 0.6);
  EXPECT_EQ(message.pose.pose.orientation.w, 0.8);
  EXPECT_EQ(message.twist.twist.linear.x, 4);
  EXPECT_EQ(message.twist.twist.angular.z, 9);
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_EQ(message.pose.covariance[i], static_cast<double>(i));
    EXPECT_EQ(message.twist.covariance[i], -static_cast<double>(i));
  }
}

TEST_F(MotionMessagesTest, GivenDiagonalsReplaceTheCovariancesOfOdometryAndAreNamedAtStart) {
  state_.base.pose_covariance.fill(7);
  state_.base.twist_covariance.fill(8);
  nav_msgs::Odometry message = odometry(state_, "odom", "base_link", stamp_);
  ReportParameters given;
  EXPECT_EQ(covariance_note(given), "");
  state_covariances(given, message);
  EXPECT_THAT(message.pose.covariance, Each(7));
  EXPECT_THAT(message.twist.covariance, Each(8));
  given.pose_covariance_diagonal = {1, 2, 3, 4, 5, 6};
  state_covariances(given, message);
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_EQ(message.pose.covariance[i], i % 7 == 0 ? static_cast<double>(i / 7 + 1) : 0) << i;
  }
  EXPECT_THAT(message.twist.covariance, Each(8)) << "not given";
  EXPECT_THAT(covariance_note(given), HasSubstr("odom: pose_covariance_diagonal given"));
}

TEST_F(MotionMessagesTest, TransformIsTheOdometrysPose) {
  state_.base.pose_odom = {.position = {1, 2, 3}, .orientation = {0, 0, 0.6, 0.8}};
  const geometry_msgs::TransformStamped message = transform(odometry(state_, "odom", "base_link", stamp_));
  EXPECT_EQ(message.header.frame_id, "odom");
  EXPECT_EQ(message.child_frame_id, "base_link");
  EXPECT_EQ(message.header.stamp, stamp_);
  EXPECT_EQ(message.transform.translation.z, 3);
  EXPECT_EQ(message.transform.rotation.z, 0.6);
}

TEST_F(MotionMessagesTest, ImuSaysWhatItDoesNotMeasure) {
  const sensor_msgs::Imu message = imu(sensors_, robot_, stamp_);
  EXPECT_EQ(message.header.frame_id, "imu_link");
  EXPECT_EQ(message.orientation_covariance[0], -1);
  EXPECT_THAT(message.angular_velocity_covariance, Each(0));
  EXPECT_THAT(message.linear_acceleration_covariance, Each(0));
  sensors_.valid = kValidOrientation;
  EXPECT_EQ(imu(sensors_, robot_, stamp_).orientation_covariance[0], 0);
  EXPECT_EQ(imu(sensors_, robot_, stamp_).angular_velocity_covariance[0], -1);
}

TEST_F(MotionMessagesTest, WheelOdometryIsTheWheelsAloneWithUnknownCovariance) {
  state_.base.pose_odom.position = {9, 9, 9};
  state_.base.pose_covariance.fill(9);
  state_.wheeled.odometry = {.x = 1, .y = 2, .yaw = 1, .linear = 3, .angular = 4};
  const nav_msgs::Odometry message = wheel_odometry(state_, "odom", "base_link", stamp_);
  EXPECT_EQ(message.header.frame_id, "odom");
  EXPECT_EQ(message.child_frame_id, "base_link");
  EXPECT_EQ(message.pose.pose.position.x, 1);
  EXPECT_EQ(message.pose.pose.position.y, 2);
  EXPECT_EQ(message.pose.pose.position.z, 0);
  EXPECT_EQ(message.pose.pose.orientation.z, std::sin(0.5));
  EXPECT_EQ(message.pose.pose.orientation.w, std::cos(0.5));
  EXPECT_EQ(message.twist.twist.linear.x, 3);
  EXPECT_EQ(message.twist.twist.angular.z, 4);
  EXPECT_THAT(message.pose.covariance, Each(0));
  EXPECT_THAT(message.twist.covariance, Each(0));
}

// The base is pitched up by a right angle (x of the base points up), and the IMU yawed by one on it. So x of the IMU is
// y of the base, and stays y of odom. The half angles are 45°, which is exact but for the rounding of √½.
TEST_F(MotionMessagesTest, ImuDataHasTheOrientationOfTheImuNotOfTheBase) {
  const double half = std::sqrt(0.5);
  state_.base.attitude = {0, -half, 0, half};
  robot_.imu_in_base.orientation = {0, 0, half, half};
  const sensor_msgs::Imu message = imu_data(sensors_, state_, robot_, EstimatorParameters{}, 0.001, stamp_);
  EXPECT_EQ(message.header.frame_id, "imu_link");
  EXPECT_EQ(message.header.stamp, stamp_);
  const auto& q = message.orientation;
  const double x_of_imu_in_odom[] = {1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.z * q.w),
                                     2 * (q.x * q.z - q.y * q.w)};
  EXPECT_NEAR(x_of_imu_in_odom[0], 0, 1e-15);
  EXPECT_NEAR(x_of_imu_in_odom[1], 1, 1e-15);
  EXPECT_NEAR(x_of_imu_in_odom[2], 0, 1e-15);
}

TEST_F(MotionMessagesTest, ImuDataCarriesTheSamplesAndEveryCovariance) {
  sensors_.imu.angular_velocity = {1, 2, 3};
  sensors_.imu.linear_acceleration = {4, 5, 6};
  state_.base.attitude_covariance = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  EstimatorParameters parameters;
  parameters.gyro_noise = 2;
  parameters.accelerometer_noise = 3;
  const sensor_msgs::Imu message = imu_data(sensors_, state_, robot_, parameters, 0.25, stamp_);
  EXPECT_EQ(message.angular_velocity.z, 3);
  EXPECT_EQ(message.linear_acceleration.x, 4);
  EXPECT_THAT(message.orientation_covariance, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_THAT(message.angular_velocity_covariance, ElementsAre(16, 0, 0, 0, 16, 0, 0, 0, 16));
  EXPECT_THAT(message.linear_acceleration_covariance, ElementsAre(36, 0, 0, 0, 36, 0, 0, 0, 36));
}

TEST_F(MotionMessagesTest, ThereIsImuDataOnlyWhereBothSensorsAreValid) {
  state_.base.flags = kStateValid;
  EXPECT_TRUE(has_imu_data(sensors_, state_));
  for (const std::uint64_t flags :
       {kStateValid | kStateNoGyro, kStateValid | kStateNoAccelerometer, std::uint64_t{0}}) {
    state_.base.flags = flags;
    EXPECT_FALSE(has_imu_data(sensors_, state_)) << flags;
  }
  state_.base.flags = kStateValid;
  for (const std::uint64_t one : {std::uint64_t{kValidGyro}, std::uint64_t{kValidAccelerometer}}) {
    sensors_.valid = one;
    EXPECT_FALSE(has_imu_data(sensors_, state_)) << one;
  }
}

TEST_F(MotionMessagesTest, VelocityOutIsWhatTheLimitsLeft) {
  command_.requested.twist.linear[0] = 9;
  command_.twist_limited.linear[0] = 0.5;
  command_.twist_limited.angular[2] = 0.2;
  const geometry_msgs::TwistStamped message = velocity_out(command_, "base_link", stamp_);
  EXPECT_EQ(message.header.frame_id, "base_link");
  EXPECT_EQ(message.twist.linear.x, 0.5);
  EXPECT_EQ(message.twist.angular.z, 0.2);
}

TEST_F(MotionMessagesTest, TwistKeepsAllSixAxes) {
  geometry_msgs::Twist message;
  message.linear.x = 1, message.linear.y = 2, message.linear.z = 3;
  message.angular.x = 4, message.angular.y = 5, message.angular.z = 6;
  const Twist twist = twist_of(message);
  EXPECT_THAT(twist.linear, ElementsAre(1, 2, 3));
  EXPECT_THAT(twist.angular, ElementsAre(4, 5, 6));
}

TEST_F(MotionMessagesTest, AnImuOfAnotherNodeIsTakenWithItsAgeAndItsGaps) {
  sensor_msgs::Imu message;
  message.angular_velocity.z = 0.5;
  message.linear_acceleration.z = 9.81;
  const ExternalImuSample sample = imu_sample(message, 1'000'000'000, 3'000'000);
  EXPECT_EQ(sample.time_ns, 997'000'000);
  EXPECT_EQ(sample.valid, kValidGyro | kValidAccelerometer);
  EXPECT_THAT(sample.imu.angular_velocity, ElementsAre(0, 0, 0.5));
  EXPECT_THAT(sample.imu.linear_acceleration, ElementsAre(0, 0, 9.81));
  message.linear_acceleration_covariance[0] = -1;
  EXPECT_EQ(imu_sample(message, 1'000'000'000, -5).valid, kValidGyro);
  EXPECT_EQ(imu_sample(message, 1'000'000'000, -5).time_ns, 1'000'000'000);
}

}  // namespace robot_control::tests
