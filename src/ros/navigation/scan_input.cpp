#include "ros/navigation/scan_input.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ros/navigation/navigation_messages.h"

namespace robot_control::navigation {

ScanInput::ScanInput(ros::NodeHandle& handle, const std::string& topic, std::function<void(const PlacedScan&)> use,
                     std::function<void(const nav_msgs::Odometry&)> odometry)
    : frames_(handle), use_(std::move(use)), heard_(std::move(odometry)), scan_(topic, 2) {
  scan_.connect_with_sender(handle, [this](const sensor_msgs::LaserScan& message, const Publisher& publisher) {
    receive(message, publisher.name);
  });
  odom_.connect(handle, [this](const nav_msgs::Odometry& message) { receive_odometry(message); });
}

std::string ScanInput::problem() const {
  const std::lock_guard lock(mutex_);
  const double now = ros::Time::now().toSec();
  const std::string scan = watch_.problem(now);
  return scan.empty() && now - used_at_ > kScanTimeout ? place_problem_ : scan;
}

std::string ScanInput::base_frame() const {
  const std::lock_guard lock(mutex_);
  return odometry_.child_frame_id;
}

void ScanInput::receive(const sensor_msgs::LaserScan& message, const std::string& publisher) {
  const std::lock_guard lock(mutex_);
  const std::string refused =
      watch_.receive(scan_of(message), publisher, message.header.stamp.toSec(), ros::Time::now().toSec(), moved_);
  if (!refused.empty()) {
    ROS_WARN_THROTTLE(10, "%s", refused.c_str());
    return;
  }
  if (!watch_.remark().empty()) ROS_WARN_THROTTLE(60, "%s", watch_.remark().c_str());
  pending_ = message;
  use_pending();
}

void ScanInput::receive_odometry(const nav_msgs::Odometry& message) {
  const auto& twist = message.twist.twist;
  const double moved = std::hypot(twist.linear.x, twist.linear.y) + std::abs(twist.angular.z);
  {
    const std::lock_guard lock(mutex_);
    if (!is_finite(uncertain_of(message.pose)) || !std::isfinite(moved)) {
      place_problem_ = "odom is not finite, or its orientation does not have the length 1";
      return;
    }
    moved_ += moved * std::clamp((message.header.stamp - odometry_.header.stamp).toSec(), 0.0, 0.1);
    odometry_ = message;
    use_pending();
  }
  heard_(message);
}

void ScanInput::use_pending() {
  if (!pending_ || odometry_.child_frame_id.empty()) return;
  const ros::Time stamp = pending_->header.stamp;
  if (const double wait = (stamp - odometry_.header.stamp).toSec(); wait > 0) {
    if (wait > kScanTimeout)
      place_problem_ = "no odom at the stamp of the scan: check the clocks of laser and robot (chrony)";
    return;
  }
  std::string why;
  const auto laser = frames_.lookup(odometry_.child_frame_id, pending_->header.frame_id, ros::Time(), why);
  const auto base = frames_.lookup(odometry_.header.frame_id, odometry_.child_frame_id, stamp, why);
  if (!laser) place_problem_ = "tf has no transform from the laser to the robot: " + why;
  if (laser && !base) place_problem_ = "tf has no pose of the robot at the stamp of the scan: " + why;
  if (!laser || !base) return;  // tf may come later than odom
  Scan scan = scan_of(*std::exchange(pending_, std::nullopt));
  if (laser->upside_down) scan.angle_min *= -1, scan.angle_increment *= -1, scan.angle_max *= -1;
  const double now = ros::Time::now().toSec();
  if (!watch_.problem(now).empty()) return;
  used_at_ = now;
  place_problem_.clear();
  use_({std::move(scan), laser->pose, {base->pose, uncertain_of(odometry_.pose).covariance}, stamp});
}

}  // namespace robot_control::navigation
