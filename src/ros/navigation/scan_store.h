#pragma once
/// Receives scans and what the collision guard says of them, in a thread of its own: planning delays neither.

#include <ros/callback_queue.h>

#include <mutex>
#include <optional>
#include <string>

#include "navigation/moving_objects.h"
#include "ros/navigation/scan_input.h"

namespace robot_control::navigation {

struct StoredScan {
  PlacedScan seen;
  std::vector<MovingObject> moving;  ///< in odom
};

/// The last report of the guard; after kScanTimeout it is as if there were none.
struct GuardReport {
  std::string reason;             ///< why the robot has little or no way; "" if it is free
  bool trusted = true;            ///< the guard trusts the lasers
  bool holds = false;             ///< it leaves the robot no way
  std::optional<Point> obstacle;  ///< in base axes: what ends the free way
};

class ScanStore {
 public:
  explicit ScanStore(const ros::NodeHandle& handle);
  ~ScanStore() { spinner_.stop(); }

  const ScanInput& input() const noexcept { return input_; }

  /// Returns the newest scan, once.
  std::optional<StoredScan> next_scan();

  GuardReport guard();

  /// Returns the velocity by the newest message of odom.
  PlanarMotion motion();

  /// Returns the frame of odom; "" before its first message.
  std::string odom_frame();

 private:
  void use(const PlacedScan& scan);
  void receive(const GuardState& message);
  void receive(const nav_msgs::Odometry& message);

  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;  // of this queue

  std::mutex mutex_;  // of all below but the input
  std::optional<StoredScan> newest_;
  MovingObjects objects_;
  GuardReport report_;
  PlanarMotion motion_;
  std::string odom_frame_;
  double reported_at_ = -1e9;  // s

  ScanInput input_;
  InputTopic<BoundedGuardState> state_{"guard_state", 1};
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace robot_control::navigation
