#pragma once
/// Conversions between messages of ROS and the types of navigation/.

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/LaserScan.h>

#include <optional>
#include <string>

#include "navigation/mrpt/localizer.h"

namespace robot_control::navigation {

inline constexpr const char* kMapFrame = "map";

/// Returns the yaw of a quaternion; NaN unless its length is 1.
double yaw_of(const geometry_msgs::Quaternion& turn);

PlanarPose planar_of(const geometry_msgs::Pose& pose);
geometry_msgs::Pose pose_message(const PlanarPose& pose);

/// Returns the velocity in a plane; none, where a component is not finite.
PlanarMotion motion_of(const geometry_msgs::Twist& twist);

/// Convert x, y and yaw with their covariance; other entries of a message are ignored, or 0.
UncertainPose uncertain_of(const geometry_msgs::PoseWithCovariance& message);
geometry_msgs::PoseWithCovariance covariance_message(const UncertainPose& pose);

bool is_finite(const UncertainPose& pose);

/// Returns the pose of a message of `initialpose`, as RViz's tool sends it. One in another frame than kMapFrame, not
/// finite, or beyond kFarthest is refused with a warning in the log: nothing is returned.
std::optional<UncertainPose> given_pose(const geometry_msgs::PoseWithCovarianceStamped& message);

/// Returns the message with the present time as its stamp.
nav_msgs::OccupancyGrid grid_message(const Grid& grid, const std::string& frame);

/// Returns the scan in the axes of its laser.
Scan scan_of(const sensor_msgs::LaserScan& message);

}  // namespace robot_control::navigation
