#include "ros/navigation/scan_store.h"

#include <cmath>
#include <utility>

#include "files/ascii.h"
#include "ros/navigation/navigation_messages.h"

namespace robot_control::navigation {
namespace {

ros::NodeHandle with_queue(ros::NodeHandle handle, ros::CallbackQueue& queue) {
  handle.setCallbackQueue(&queue);
  return handle;
}

}  // namespace

ScanStore::ScanStore(const ros::NodeHandle& handle)
    : handle_(with_queue(handle, queue_)),
      input_(
          handle_, "scan", [this](const PlacedScan& scan) { use(scan); },
          [this](const nav_msgs::Odometry& odometry) { receive(odometry); }) {
  state_.connect(handle_, [this](const GuardState& message) { receive(message); });
  spinner_.start();
}

std::optional<StoredScan> ScanStore::next_scan() {
  const std::lock_guard lock(mutex_);
  return std::exchange(newest_, std::nullopt);
}

GuardReport ScanStore::guard() {
  const std::lock_guard lock(mutex_);
  return ros::SteadyTime::now().toSec() - reported_at_ > kScanTimeout ? GuardReport() : report_;
}

PlanarMotion ScanStore::motion() {
  const std::lock_guard lock(mutex_);
  return motion_;
}

std::string ScanStore::odom_frame() {
  const std::lock_guard lock(mutex_);
  return odom_frame_;
}

void ScanStore::receive(const nav_msgs::Odometry& message) {
  const std::lock_guard lock(mutex_);
  motion_ = motion_of(message.twist.twist);
  odom_frame_ = message.header.frame_id;
}

void ScanStore::use(const PlacedScan& scan) {
  const std::lock_guard lock(mutex_);
  newest_ = {scan, objects_.update(scan.scan, composed(scan.odometry.mean, scan.laser), scan.stamp.toSec())};
}

void ScanStore::receive(const GuardState& message) {
  const std::lock_guard lock(mutex_);
  report_ = {ascii(message.reason), message.trusted != 0, !(message.clearance > 0), {}};
  const Point obstacle{message.obstacle.x, message.obstacle.y};
  if (std::hypot(obstacle.x, obstacle.y) < kFarthest) report_.obstacle = obstacle;
  reported_at_ = ros::SteadyTime::now().toSec();
}

}  // namespace robot_control::navigation
