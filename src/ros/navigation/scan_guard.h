#pragma once
/// Publishes `clearance` from the laser while a goal is driven, in a thread of its own: planning delays it by nothing.
///
/// With a scan that does not count the clearance is 0, and the robot stands. After the goal, once the robot has stood
/// for 1 s, it is infinite, so that the robot can be driven by hand. The start is as the end of a goal. A navigate that
/// ended while it drove has left the clearance 0 and a path. That goes on until follow_path hears that it is cancelled.

#include <ros/callback_queue.h>
#include <std_msgs/Float64.h>

#include <mutex>
#include <optional>
#include <string>

#include "navigation/guard.h"
#include "ros/navigation/scan_input.h"

namespace robot_control::navigation {

struct GuardedScan {
  PlacedScan seen;
  std::vector<Point> ahead;  ///< in base axes: places that things in motion will take
};

class ScanGuard {
 public:
  ScanGuard(const ros::NodeHandle& handle, Footprint footprint);
  ~ScanGuard() { spinner_.stop(); }

  const ScanInput& input() const noexcept { return input_; }

  /// `intended` is the motion that begins next, where the robot stands.
  void guard(bool active, const PlanarMotion& intended);

  /// Returns the newest scan, once.
  std::optional<GuardedScan> next_scan();

  /// Returns what slows the robot, in words; "" if the way ahead is free.
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
  int stood_ = 0;  // ticks

  ScanInput input_;
  ros::WallTimer timer_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace robot_control::navigation
