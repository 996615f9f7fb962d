#include "ros/navigation/scan_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "signals/formatted_text.h"

namespace robot_control::navigation {
namespace {

constexpr double kWatchPeriod = 0.1;       // s
constexpr double kStandstillSpeed = 0.02;  // m/s, rad/s
constexpr int kStandstillTicks = 10;       // ticks

ros::NodeHandle with_queue(ros::NodeHandle handle, ros::CallbackQueue& queue) {
  handle.setCallbackQueue(&queue);
  return handle;
}

}  // namespace

ScanGuard::ScanGuard(const ros::NodeHandle& handle, Footprint footprint)
    : footprint_(std::move(footprint)),
      handle_(with_queue(handle, queue_)),
      input_(
          handle_, [this](const PlacedScan& scan) { use(scan); },
          [this](const nav_msgs::Odometry& odometry) {
            const std::lock_guard lock(mutex_);
            measured_ = {odometry.twist.twist.linear.x, odometry.twist.twist.angular.z};
          }) {
  timer_ = handle_.createWallTimer(ros::WallDuration(kWatchPeriod), [this](const ros::WallTimerEvent&) { watch(); });
  spinner_.start();
}

void ScanGuard::guard(bool active, const PlanarMotion& intended) {
  const std::lock_guard lock(mutex_);
  active_ = active;
  intended_ = intended;
}

std::optional<GuardedScan> ScanGuard::next_scan() {
  const std::lock_guard lock(mutex_);
  return std::exchange(newest_, std::nullopt);
}

std::string ScanGuard::reason() {
  const std::lock_guard lock(mutex_);
  if (!guards_ || published_ > 0.3) return "";
  return formatted("the laser sees an obstacle %.2f m in front of the robot", published_ + kRemainingGap + kLaserNoise);
}

void ScanGuard::use(const PlacedScan& scan) {
  const std::lock_guard lock(mutex_);
  const PlanarPose& base = scan.odometry.mean;
  const std::vector<MovingObject> objects =
      in_base_axes(objects_.update(scan.scan, composed(base, scan.laser), scan.stamp.toSec()), base);
  newest_ = {scan, predicted_points(objects, footprint_)};
  const bool moves =
      std::abs(measured_.linear) > kStandstillSpeed || std::abs(measured_.angular) > 2 * kStandstillSpeed;
  const double free =
      clearance_along(footprint_, points_of(scan.scan, scan.laser), moves ? measured_ : intended_, objects);
  const double age = std::clamp((ros::Time::now() - scan.stamp).toSec(), 0.0, kScanTimeout);
  if (guards_) publish(std::max(0.0, free - std::abs(measured_.linear) * age));
}

void ScanGuard::watch() {
  const bool trusted = input_.problem().empty();
  const std::lock_guard lock(mutex_);
  const bool stands = std::abs(measured_.linear) < kStandstillSpeed && std::abs(measured_.angular) < kStandstillSpeed;
  standstill_ticks_ = stands ? standstill_ticks_ + 1 : 0;
  if (!active_ && guards_ && standstill_ticks_ >= kStandstillTicks) {
    guards_ = false;
    publish(std::numeric_limits<double>::infinity());
  }
  if (active_ && !guards_) guards_ = true, publish(0);
  if (guards_ && !trusted) publish(0);
}

void ScanGuard::publish(double clearance) {
  std_msgs::Float64 message;
  message.data = published_ = clearance;
  clearance_.publish(message);
}

}  // namespace robot_control::navigation
