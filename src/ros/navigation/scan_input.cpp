#include "ros/navigation/scan_input.h"

#include <cmath>
#include <utility>

#include "ros/navigation/given_pose.h"

namespace robot_control {
namespace {

constexpr std::size_t kReadings = 250;  // 5 s at 50 Hz

/// Returns the scan in the axes of a laser whose z points upwards.
Scan scan_of(const sensor_msgs::LaserScan& message, bool upside_down) {
  const double sign = upside_down ? -1 : 1;
  return {sign * message.angle_min, sign * message.angle_increment, message.range_min, message.range_max,
          message.ranges,           sign * message.angle_max};
}

double turn_between(double from, double to) {
  return std::remainder(to - from, 2 * M_PI);
}

}  // namespace

ScanInput::ScanInput(ros::NodeHandle& handle, std::function<void(const PlacedScan&)> use,
                     std::function<void(const nav_msgs::Odometry&)> odometry)
    : frames_(handle), use_(std::move(use)), odometry_(std::move(odometry)) {
  scan_ = handle.subscribe("scan", 2, &ScanInput::receive, this, ros::TransportHints().tcpNoDelay());
  odom_ = handle.subscribe("odom", 50, &ScanInput::receive_odometry, this, ros::TransportHints().tcpNoDelay());
}

std::string ScanInput::problem() const {
  const std::string scan = watch_.problem(ros::Time::now().toSec());
  return scan.empty() ? place_problem_ : scan;
}

void ScanInput::receive(const ros::MessageEvent<const sensor_msgs::LaserScan>& event) {
  const sensor_msgs::LaserScan& message = *event.getMessage();
  const std::string refused = watch_.receive(scan_of(message, false), event.getPublisherName(),
                                             message.header.stamp.toSec(), ros::Time::now().toSec(), moved_);
  if (!refused.empty()) {
    ROS_WARN_THROTTLE(10, "%s", refused.c_str());
    return;
  }
  pending_ = message;
  use_pending();
}

void ScanInput::receive_odometry(const nav_msgs::Odometry& message) {
  const UncertainPose pose = planar_part(message.pose);
  if (!is_finite(pose)) {
    place_problem_ = "odom is not finite, or its orientation has not the length 1";
    return;
  }
  if (!readings_.empty()) {
    const Reading& last = readings_.back();
    if (message.header.stamp < last.stamp)
      readings_.clear();  // the robot was started again
    else
      moved_ += std::hypot(pose.mean.x - last.pose.mean.x, pose.mean.y - last.pose.mean.y) +
                std::abs(turn_between(last.pose.mean.yaw, pose.mean.yaw));
  }
  readings_.push_back({message.header.stamp, pose});
  if (readings_.size() > kReadings) readings_.pop_front();
  base_frame_ = message.child_frame_id;
  use_pending();
  odometry_(message);
}

std::optional<UncertainPose> ScanInput::odometry_at(ros::Time stamp) const {
  for (std::size_t i = readings_.size(); i-- > 0;) {
    if (readings_[i].stamp > stamp) continue;
    UncertainPose pose = readings_[i].pose;
    if (i + 1 == readings_.size()) return pose;
    const Reading& next = readings_[i + 1];
    const double part = (stamp - readings_[i].stamp).toSec() / (next.stamp - readings_[i].stamp).toSec();
    pose.mean.x += part * (next.pose.mean.x - pose.mean.x);
    pose.mean.y += part * (next.pose.mean.y - pose.mean.y);
    pose.mean.yaw += part * turn_between(pose.mean.yaw, next.pose.mean.yaw);
    return pose;
  }
  return std::nullopt;
}

void ScanInput::use_pending() {
  if (!pending_ || readings_.empty() || readings_.back().stamp < pending_->header.stamp) return;
  const sensor_msgs::LaserScan message = *std::exchange(pending_, std::nullopt);
  std::string why;
  const auto laser = frames_.lookup(base_frame_, message.header.frame_id, ros::Time(), why);
  const auto odometry = odometry_at(message.header.stamp);
  place_problem_.clear();
  if (!laser) {
    place_problem_ = "tf does not give the place of the laser on the robot: " + why;
  } else if (!odometry) {
    place_problem_ = "there is no odom at the stamp of the scan: synchronise the clocks of laser and robot";
  } else {
    return use_({scan_of(message, laser->upside_down), laser->pose, *odometry, message.header.stamp});
  }
  ROS_WARN_THROTTLE(10, "%s", place_problem_.c_str());
}

}  // namespace robot_control
