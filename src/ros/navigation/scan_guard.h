#pragma once
/// Publishes `clearance` from the laser while a goal is driven, in a thread of its own: planning delays it by nothing.
///
/// With a scan that does not count the clearance is 0, and the robot stands. After the goal, once the robot stands, it
/// is infinite, so that the robot can be driven by hand.

#include <nav_msgs/Odometry.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/LaserScan.h>

#include <mutex>
#include <optional>
#include <string>

#include "navigation/guard.h"
#include "navigation/scan_watch.h"
#include "ros/navigation/frames.h"

namespace robot_control {

struct StampedScan {
  Scan scan;
  std::string frame;
  ros::Time stamp;
  std::vector<Point> ahead;  ///< in base axes: places that things in motion will take
};

class ScanGuard {
 public:
  ScanGuard(ros::NodeHandle& handle, Footprint footprint, const Frames& frames);
  ~ScanGuard() { spinner_.stop(); }

  /// `intended` is the motion that begins next, where the robot stands.
  void guard(bool active, const PlanarMotion& intended);

  /// Returns why the laser cannot be trusted now; "" if it can.
  std::string problem();

  /// Returns the newest accepted scan, once.
  std::optional<StampedScan> next_scan();

  /// Returns what slows the robot, in words; "" if the way ahead is free.
  std::string held();

  /// Returns the frames of odometry and base; empty before the first message of `odom`.
  std::pair<std::string, std::string> odometry_frames();

 private:
  void receive(const ros::MessageEvent<const sensor_msgs::LaserScan>& event);
  void receive_odometry(const nav_msgs::Odometry& message);
  void watch();
  void publish(double clearance);
  double clearance_of(StampedScan& scan);

  const Footprint footprint_;
  const Frames& frames_;
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_{1, &queue_};
  ros::Publisher clearance_;
  ros::Subscriber scan_, odom_;
  ros::WallTimer timer_;

  std::mutex mutex_;  // of all below
  ScanWatch watch_;
  std::optional<StampedScan> newest_;
  std::string frame_problem_, odom_frame_, base_frame_;
  PlanarMotion measured_, intended_;
  PlanarPose base_;  // in odom
  Movers movers_;
  double moved_ = 0, published_ = 0;  // m + rad; m
  ros::Time odometry_at_;
  bool active_ = false, guards_ = false;
};

}  // namespace robot_control
