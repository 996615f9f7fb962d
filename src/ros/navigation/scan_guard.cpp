#include "ros/navigation/scan_guard.h"

#include <std_msgs/Float64.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <tuple>

namespace robot_control {
namespace {

constexpr double kTick = 0.1;       // s
constexpr double kStanding = 0.02;  // m/s, rad/s

Scan scan_of(const sensor_msgs::LaserScan& message) {
  return {message.angle_min, message.angle_increment, message.range_min,
          message.range_max, message.ranges,          message.angle_max};
}

}  // namespace

ScanGuard::ScanGuard(ros::NodeHandle& given, Footprint footprint, const Frames& frames)
    : footprint_(std::move(footprint)), frames_(frames) {
  ros::NodeHandle handle(given);
  handle.setCallbackQueue(&queue_);
  clearance_ = handle.advertise<std_msgs::Float64>("clearance", 1);
  scan_ = handle.subscribe("scan", 1, &ScanGuard::receive, this, ros::TransportHints().tcpNoDelay());
  odom_ = handle.subscribe("odom", 1, &ScanGuard::receive_odometry, this, ros::TransportHints().tcpNoDelay());
  timer_ = handle.createWallTimer(ros::WallDuration(kTick), [this](const ros::WallTimerEvent&) { watch(); });
  spinner_.start();
}

void ScanGuard::guard(bool active, const PlanarMotion& intended) {
  const std::lock_guard lock(mutex_);
  active_ = active;
  intended_ = intended;
}

std::string ScanGuard::problem() {
  const std::lock_guard lock(mutex_);
  if (base_frame_.empty()) return "no odom has come: start the robot";
  const std::string problem = watch_.problem(ros::Time::now().toSec());
  return problem.empty() ? frame_problem_ : problem;
}

std::optional<StampedScan> ScanGuard::next_scan() {
  const std::lock_guard lock(mutex_);
  return std::exchange(newest_, std::nullopt);
}

std::string ScanGuard::held() {
  const std::lock_guard lock(mutex_);
  if (!guards_ || published_ > 0.3) return "";
  std::array<char, 80> text;
  std::snprintf(text.data(), text.size(), "the laser sees something %.2f m before the outline",
                published_ + kStopShort + kBeside);
  return text.data();
}

std::pair<std::string, std::string> ScanGuard::odometry_frames() {
  const std::lock_guard lock(mutex_);
  return {odom_frame_, base_frame_};
}

void ScanGuard::receive_odometry(const nav_msgs::Odometry& message) {
  const std::lock_guard lock(mutex_);
  odom_frame_ = message.header.frame_id, base_frame_ = message.child_frame_id;
  const auto& [position, turn] = std::tie(message.pose.pose.position, message.pose.pose.orientation);
  base_ = {position.x, position.y, yaw_of(turn.x, turn.y, turn.z, turn.w).value_or(base_.yaw)};
  measured_ = {message.twist.twist.linear.x, message.twist.twist.angular.z};
  const double elapsed = std::clamp((message.header.stamp - odometry_at_).toSec(), 0.0, 0.1);
  moved_ += (std::abs(measured_.linear) + std::abs(measured_.angular)) * elapsed;
  odometry_at_ = message.header.stamp;
}

void ScanGuard::receive(const ros::MessageEvent<const sensor_msgs::LaserScan>& event) {
  const sensor_msgs::LaserScan& message = *event.getConstMessage();
  StampedScan scan{scan_of(message), message.header.frame_id, message.header.stamp, {}};
  const std::lock_guard lock(mutex_);
  const std::string refused = watch_.receive(scan.scan, event.getPublisherName(), message.header.stamp.toSec(),
                                             ros::Time::now().toSec(), moved_);
  if (!refused.empty()) {
    ROS_WARN_THROTTLE(10, "%s", refused.c_str());
    return;
  }
  const double clearance = clearance_of(scan);
  if (frame_problem_.empty()) newest_ = std::move(scan);
  if (guards_) publish(clearance);
}

double ScanGuard::clearance_of(StampedScan& scan) {
  frame_problem_.clear();
  std::string why;
  const auto sensor = frames_.lookup(base_frame_, scan.frame, ros::Time(), why);
  if (!sensor) {
    frame_problem_ = "tf does not give the place of the laser on the robot: " + why;
    return 0;
  }
  if (!watch_.problem(ros::Time::now().toSec()).empty()) return 0;
  Scan upright = scan.scan;
  if (sensor->upside_down) upright.angle_min *= -1, upright.angle_increment *= -1;
  const bool moves = std::abs(measured_.linear) > kStanding || std::abs(measured_.angular) > 2 * kStanding;
  const std::vector<Mover> movers =
      movers_seen_from(movers_.update(upright, composed(base_, sensor->pose), scan.stamp.toSec()), base_, footprint_);
  scan.ahead = places_ahead(movers);
  const double free = free_way(footprint_, points_of(upright, sensor->pose), moves ? measured_ : intended_, movers);
  const double age = std::clamp((ros::Time::now() - scan.stamp).toSec(), 0.0, kSilence);
  return std::max(0.0, free - std::abs(measured_.linear) * age);
}

void ScanGuard::watch() {
  const std::lock_guard lock(mutex_);
  const bool stands = std::abs(measured_.linear) < kStanding && std::abs(measured_.angular) < kStanding;
  if (!active_ && guards_ && stands) {
    guards_ = false;
    publish(std::numeric_limits<double>::infinity());
  }
  if (active_ && !guards_) guards_ = true, publish(0);
  if (guards_ && !watch_.problem(ros::Time::now().toSec()).empty()) publish(0);
}

void ScanGuard::publish(double clearance) {
  std_msgs::Float64 message;
  message.data = published_ = clearance;
  clearance_.publish(message);
}

}  // namespace robot_control
