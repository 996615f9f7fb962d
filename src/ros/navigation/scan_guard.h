#pragma once
/// Publishes `clearance` from the laser while a goal is driven, in a thread of its own: planning delays it by nothing.
///
/// While no scan is accepted the clearance is 0, and the robot stands. After the goal, once the robot has stood still
/// for 1 s, it is infinite, so that the robot can be driven manually. The node starts in the same state. If it ended
/// while driving, the clearance is still 0 and follow_path still has a path, until that path is cancelled.

#include <ros/callback_queue.h>
#include <std_msgs/Float64.h>

#include <mutex>
#include <optional>
#include <string>

#include "navigation/motion_clearance.h"
#include "ros/navigation/scan_input.h"

namespace robot_control::navigation {

struct GuardedScan {
  PlacedScan seen;
  std::vector<Point> predicted;  ///< in base axes: points that moving objects will occupy
};

class ScanGuard {
 public:
  ScanGuard(const ros::NodeHandle& handle, Footprint footprint);
  ~ScanGuard() { spinner_.stop(); }

  const ScanInput& input() const noexcept { return input_; }

  /// `intended` is the motion that begins next, used while the robot stands.
  void guard(bool active, const PlanarMotion& intended);

  /// Returns the newest scan, once.
  std::optional<GuardedScan> next_scan();

  /// Returns what slows the robot, in words; "" if the path ahead is free.
  std::string reason();

 private:
  void use(const PlacedScan& scan);
  void watch();
  void publish(double clearance);

  const Footprint footprint_;
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;  // of this queue
  ros::Publisher clearance_ = handle_.advertise<std_msgs::Float64>("clearance", 1, true);

  std::mutex mutex_;  // of all below but the input
  std::optional<GuardedScan> newest_;
  PlanarMotion measured_, intended_;
  MovingObjects objects_;
  double published_ = 0;  // m
  bool active_ = false, guards_ = true;
  int standstill_ticks_ = 0;  // ticks

  ScanInput input_;
  ros::WallTimer timer_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace robot_control::navigation
