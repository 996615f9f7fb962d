#pragma once
/// A ScanInput joins each scan with the place of the robot in odom at its stamp, and with that of the laser on the
/// robot. Both are from tf, the covariance from `odom`.
///
/// A scan waits for a message of `odom` that is not older. One is not used that ScanWatch refuses or does not count,
/// or whose place is not in tf; `problem` says why after kScanTimeout without a scan that is used.

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "navigation/mrpt/localizer.h"
#include "navigation/scan_watch.h"
#include "ros/navigation/frames.h"

namespace robot_control::navigation {

struct PlacedScan {
  Scan scan;               ///< its angles in axes whose z points upwards
  PlanarPose laser;        ///< in the base
  UncertainPose odometry;  ///< of the base in odom, at the stamp
  ros::Time stamp;
};

class ScanInput {
 public:
  /// `use` is called for each scan of `topic`, `odometry` for each message of odom, in the thread of the handle's
  /// queue.
  ScanInput(ros::NodeHandle& handle, const std::string& topic, std::function<void(const PlacedScan&)> use,
            std::function<void(const nav_msgs::Odometry&)> odometry);

  // Any thread may call these, but not from within `use`.

  /// Returns why no scan is used now; "" if they are.
  std::string problem() const;

  /// Returns the frame of the base; "" before the first message of odom.
  std::string base_frame() const;

  const Frames& frames() const noexcept { return frames_; }

 private:
  void receive(const sensor_msgs::LaserScan& message, const std::string& publisher);
  void receive_odometry(const nav_msgs::Odometry& message);
  void use_pending();

  Frames frames_;
  std::function<void(const PlacedScan&)> use_;
  std::function<void(const nav_msgs::Odometry&)> heard_;

  mutable std::mutex mutex_;  // of all below
  ScanWatch watch_;
  std::optional<sensor_msgs::LaserScan> pending_;
  nav_msgs::Odometry odometry_;  // the newest
  std::string place_problem_ = "no odom received: start the robot";
  double moved_ = 0, used_at_ = -1e9;  // m + rad; s
  InputTopic<BoundedLaserScan> scan_;
  InputTopic<BoundedOdometry> odom_{"odom", 50};
};

}  // namespace robot_control::navigation
