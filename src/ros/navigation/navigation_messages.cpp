#include "ros/navigation/navigation_messages.h"

#include <ros/ros.h>

#include <cmath>

namespace robot_control::navigation {
namespace {

constexpr std::size_t kPlanarAxes[] = {0, 1, 5};  // x, y, yaw among x y z roll pitch yaw

}  // namespace

double yaw_of(const geometry_msgs::Quaternion& turn) {
  const double x = turn.x, y = turn.y, z = turn.z, w = turn.w;
  if (!(std::abs(x * x + y * y + z * z + w * w - 1) < 0.01)) return NAN;
  return std::atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
}

PlanarPose planar_of(const geometry_msgs::Pose& pose) {
  return {pose.position.x, pose.position.y, yaw_of(pose.orientation)};
}

geometry_msgs::Pose pose_message(const PlanarPose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.x;
  message.position.y = pose.y;
  message.orientation.z = std::sin(pose.yaw / 2);
  message.orientation.w = std::cos(pose.yaw / 2);
  return message;
}

PlanarMotion motion_of(const geometry_msgs::Twist& twist) {
  const PlanarMotion motion{twist.linear.x, twist.angular.z, twist.linear.y};
  return std::isfinite(motion.linear + motion.angular + motion.lateral) ? motion : PlanarMotion();
}

UncertainPose uncertain_of(const geometry_msgs::PoseWithCovariance& message) {
  UncertainPose result{planar_of(message.pose)};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      result.covariance(row, column) = message.covariance[6 * kPlanarAxes[row] + kPlanarAxes[column]];
  return result;
}

geometry_msgs::PoseWithCovariance covariance_message(const UncertainPose& pose) {
  geometry_msgs::PoseWithCovariance message;
  message.pose = pose_message(pose.mean);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      message.covariance[6 * kPlanarAxes[row] + kPlanarAxes[column]] = pose.covariance(row, column);
  return message;
}

bool is_finite(const UncertainPose& pose) {
  return std::isfinite(pose.mean.x + pose.mean.y + pose.mean.yaw) && pose.covariance.allFinite();
}

std::optional<UncertainPose> given_pose(const geometry_msgs::PoseWithCovarianceStamped& message) {
  const UncertainPose pose = uncertain_of(message.pose);
  if (message.header.frame_id != kMapFrame) {
    ROS_WARN("initialpose is refused: its frame is '%s', it must be 'map'", message.header.frame_id.c_str());
  } else if (!is_finite(pose)) {
    ROS_WARN("initialpose is refused: it is not finite, or its orientation does not have the length 1");
  } else if (std::hypot(pose.mean.x, pose.mean.y) > kFarthest) {
    ROS_WARN("initialpose is refused: it is beyond 1000 km");
  } else {
    return pose;
  }
  return std::nullopt;
}

nav_msgs::OccupancyGrid grid_message(const Grid& grid, const std::string& frame) {
  nav_msgs::OccupancyGrid message;
  message.header.frame_id = frame;
  message.header.stamp = message.info.map_load_time = ros::Time::now();
  message.info.width = static_cast<std::uint32_t>(grid.columns);
  message.info.height = static_cast<std::uint32_t>(grid.rows);
  message.info.resolution = static_cast<float>(grid.resolution);
  message.info.origin = pose_message({grid.origin_x, grid.origin_y, 0});
  message.data = grid.cells;
  return message;
}

Scan scan_of(const sensor_msgs::LaserScan& message) {
  return {message.angle_min, message.angle_increment, message.range_min,
          message.range_max, message.ranges,          message.angle_max};
}

}  // namespace robot_control::navigation
