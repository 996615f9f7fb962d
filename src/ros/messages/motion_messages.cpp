#include "ros/messages/motion_messages.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control {
namespace {

geometry_msgs::Vector3 vector_message(const Vector3& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector[0];
  message.y = vector[1];
  message.z = vector[2];
  return message;
}

geometry_msgs::Quaternion quaternion_message(const Quaternion& quaternion) {
  geometry_msgs::Quaternion message;
  message.x = quaternion[0];
  message.y = quaternion[1];
  message.z = quaternion[2];
  message.w = quaternion[3];
  return message;
}

geometry_msgs::Twist twist_message(const Twist& twist) {
  geometry_msgs::Twist message;
  message.linear = vector_message(twist.linear);
  message.angular = vector_message(twist.angular);
  return message;
}

nav_msgs::Odometry odometry_of(const Pose& pose, const Twist& twist, const std::string& odom_frame,
                               const std::string& base_frame, ros::Time stamp) {
  nav_msgs::Odometry message;
  message.header.stamp = stamp;
  message.header.frame_id = odom_frame;
  message.child_frame_id = base_frame;
  message.pose.pose.position.x = pose.position[0];
  message.pose.pose.position.y = pose.position[1];
  message.pose.pose.position.z = pose.position[2];
  message.pose.pose.orientation = quaternion_message(pose.orientation);
  message.twist.twist = twist_message(twist);
  return message;
}

}  // namespace

Twist twist_of(const geometry_msgs::Twist& message) {
  return {.linear = {message.linear.x, message.linear.y, message.linear.z},
          .angular = {message.angular.x, message.angular.y, message.angular.z}};
}

sensor_msgs::JointState joint_states(const SensorFrame& sensors, const StateFrame* state, const MachineModel& robot,
                                     ros::Time stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    message.name.push_back(robot.joints[i].name);
    message.position.push_back(sensors.joints[i].position);
    message.velocity.push_back(state != nullptr ? state->joint_velocity[i] : sensors.joints[i].velocity);
    message.effort.push_back(sensors.joints[i].effort);
  }
  return message;
}

nav_msgs::Odometry odometry(const StateFrame& state, const std::string& odom_frame, const std::string& base_frame,
                            ros::Time stamp) {
  nav_msgs::Odometry message = odometry_of(state.base.pose_odom, state.base.twist_base, odom_frame, base_frame, stamp);
  std::ranges::copy(state.base.pose_covariance, message.pose.covariance.begin());
  std::ranges::copy(state.base.twist_covariance, message.twist.covariance.begin());
  return message;
}

void state_covariances(const ReportParameters& given, nav_msgs::Odometry& message) {
  const auto replace = [](const std::optional<CovarianceDiagonal>& diagonal, auto& covariance) {
    if (!diagonal) return;
    covariance.fill(0);
    for (std::size_t i = 0; i < diagonal->size(); ++i) covariance[i * (diagonal->size() + 1)] = (*diagonal)[i];
  };
  replace(given.pose_covariance_diagonal, message.pose.covariance);
  replace(given.twist_covariance_diagonal, message.twist.covariance);
}

std::string covariance_note(const ReportParameters& given) {
  const bool pose = given.pose_covariance_diagonal.has_value();
  const bool twist = given.twist_covariance_diagonal.has_value();
  if (!pose && !twist) return "";
  const std::string keys = std::string(pose ? "pose_covariance_diagonal" : "") + (pose && twist ? " and " : "") +
                           (twist ? "twist_covariance_diagonal" : "");
  return "odom: " + keys + " given: constant, whatever the estimate's uncertainty is. Leave out to publish that";
}

geometry_msgs::TransformStamped transform(const nav_msgs::Odometry& odometry) {
  geometry_msgs::TransformStamped message;
  message.header = odometry.header;
  message.child_frame_id = odometry.child_frame_id;
  message.transform.translation.x = odometry.pose.pose.position.x;
  message.transform.translation.y = odometry.pose.pose.position.y;
  message.transform.translation.z = odometry.pose.pose.position.z;
  message.transform.rotation = odometry.pose.pose.orientation;
  return message;
}

nav_msgs::Odometry wheel_odometry(const StateFrame& state, const std::string& odom_frame, const std::string& base_frame,
                                  ros::Time stamp) {
  const WheelOdometry& wheels = state.wheeled.odometry;
  const Pose pose{.position = {wheels.x, wheels.y, 0},
                  .orientation = {0, 0, std::sin(wheels.yaw / 2), std::cos(wheels.yaw / 2)}};
  return odometry_of(pose, {.linear = {wheels.linear, 0, 0}, .angular = {0, 0, wheels.angular}}, odom_frame, base_frame,
                     stamp);
}

nav_msgs::Odometry ground_truth(const TruthFrame& truth, const std::string& odom_frame, const std::string& base_frame,
                                ros::Time stamp) {
  return odometry_of(truth.pose_world, truth.twist_base, odom_frame, base_frame, stamp);
}

const std::string& imu_frame(const MachineModel& robot) {
  return robot.imu_link.empty() ? robot.base_link : robot.imu_link;
}

ExternalImuSample imu_sample(const sensor_msgs::Imu& message, std::int64_t now_ns, std::int64_t age_ns) {
  const auto vector = [](const auto& from) { return Vector3{from.x, from.y, from.z}; };
  ExternalImuSample sample{.imu = {.angular_velocity = vector(message.angular_velocity),
                                   .linear_acceleration = vector(message.linear_acceleration)},
                           .valid = 0,
                           .time_ns = now_ns - std::clamp<std::int64_t>(age_ns, 0, ExternalImu::kImuLife)};
  if (message.angular_velocity_covariance[0] >= 0) sample.valid |= kValidGyro;
  if (message.linear_acceleration_covariance[0] >= 0) sample.valid |= kValidAccelerometer;
  return sample;
}

sensor_msgs::LaserScan laser_scan(const LaserScan& scan, ros::Time stamp) {
  sensor_msgs::LaserScan message;
  message.header.stamp = stamp;
  message.header.frame_id = scan.link;
  message.angle_min = static_cast<float>(scan.angle_min);
  message.angle_max =
      static_cast<float>(scan.angle_min + scan.angle_increment * (static_cast<double>(scan.ranges.size()) - 1));
  message.angle_increment = static_cast<float>(scan.angle_increment);
  message.range_min = static_cast<float>(scan.range_min);
  message.range_max = static_cast<float>(scan.range_max);
  message.ranges.assign(scan.ranges.begin(), scan.ranges.end());
  return message;
}

sensor_msgs::Imu imu(const SensorFrame& sensors, const MachineModel& robot, ros::Time stamp) {
  sensor_msgs::Imu message;
  message.header.stamp = stamp;
  message.header.frame_id = imu_frame(robot);
  message.angular_velocity = vector_message(sensors.imu.angular_velocity);
  message.linear_acceleration = vector_message(sensors.imu.linear_acceleration);
  message.orientation = quaternion_message(sensors.imu.orientation);
  constexpr double kNotMeasured = -1;
  if ((sensors.valid & kValidOrientation) == 0) message.orientation_covariance[0] = kNotMeasured;
  if ((sensors.valid & kValidGyro) == 0) message.angular_velocity_covariance[0] = kNotMeasured;
  if ((sensors.valid & kValidAccelerometer) == 0) message.linear_acceleration_covariance[0] = kNotMeasured;
  return message;
}

sensor_msgs::Imu imu_data(const SensorFrame& sensors, const StateFrame& state, const MachineModel& robot,
                          const EstimatorParameters& parameters, double period, ros::Time stamp) {
  sensor_msgs::Imu message = imu(sensors, robot, stamp);
  const auto rotation = [](const Quaternion& q) { return Eigen::Quaterniond(q[3], q[0], q[1], q[2]); };
  const Eigen::Quaterniond q = rotation(state.base.attitude) * rotation(robot.imu_in_base.orientation);
  message.orientation = quaternion_message({q.x(), q.y(), q.z(), q.w()});
  std::ranges::copy(state.base.attitude_covariance, message.orientation_covariance.begin());
  const double gyro = parameters.gyro_noise * parameters.gyro_noise / period;
  const double accelerometer = parameters.accelerometer_noise * parameters.accelerometer_noise / period;
  for (const std::size_t diagonal : {0, 4, 8}) {
    message.angular_velocity_covariance[diagonal] = gyro;
    message.linear_acceleration_covariance[diagonal] = accelerometer;
  }
  return message;
}

bool has_imu_data(const SensorFrame& sensors, const StateFrame& state) {
  constexpr std::uint64_t kMeasured = kValidGyro | kValidAccelerometer;
  constexpr std::uint64_t kUnusedImu = kStateNoGyro | kStateNoAccelerometer;
  return (sensors.valid & kMeasured) == kMeasured && (state.base.flags & kUnusedImu) == 0 &&
         (state.base.flags & kStateValid) != 0;
}

sensor_msgs::BatteryState battery_state(const SensorFrame& sensors, ros::Time stamp) {
  constexpr float kUnmeasured = std::numeric_limits<float>::quiet_NaN();
  sensor_msgs::BatteryState message;
  message.header.stamp = stamp;
  message.voltage = static_cast<float>(sensors.battery_voltage);
  message.current = static_cast<float>(-sensors.battery_current);
  message.temperature = message.charge = message.capacity = message.design_capacity = message.percentage = kUnmeasured;
  message.power_supply_status = sensors.battery_current > 0 ? sensor_msgs::BatteryState::POWER_SUPPLY_STATUS_DISCHARGING
                                                            : sensor_msgs::BatteryState::POWER_SUPPLY_STATUS_UNKNOWN;
  message.present = 1;
  return message;
}

namespace {

geometry_msgs::TwistStamped stamped(const Twist& twist, const std::string& base_frame, ros::Time stamp) {
  geometry_msgs::TwistStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = base_frame;
  message.twist = twist_message(twist);
  return message;
}

}  // namespace

geometry_msgs::TwistStamped velocity_out(const CommandFrame& command, const std::string& base_frame, ros::Time stamp) {
  return stamped(command.twist_limited, base_frame, stamp);
}

geometry_msgs::TwistStamped velocity_requested(const CommandFrame& command, const std::string& base_frame,
                                               ros::Time stamp) {
  return stamped(command.requested.twist, base_frame, stamp);
}

}  // namespace robot_control
