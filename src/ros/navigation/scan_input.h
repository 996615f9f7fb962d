#pragma once
/// A ScanInput joins each scan with the pose of the odometry at its stamp and with the place of the laser on the robot.
///
/// A scan waits for a message of `odom` that is not older; the pose is interpolated between two. A scan that ScanWatch
/// refuses, without odometry around its stamp, or whose frame is not in tf, is not used; `problem` says why.

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/LaserScan.h>

#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "navigation/mrpt/localizer.h"
#include "navigation/scan_watch.h"
#include "ros/navigation/frames.h"

namespace robot_control {

struct PlacedScan {
  Scan scan;
  PlanarPose laser;        ///< in the base
  UncertainPose odometry;  ///< of the base in odom, at the stamp
  ros::Time stamp;
};

class ScanInput {
 public:
  /// `use` is called for each scan, `odometry` for each message of odom.
  ScanInput(ros::NodeHandle& handle, std::function<void(const PlacedScan&)> use,
            std::function<void(const nav_msgs::Odometry&)> odometry);

  /// Returns why no scan is used now; "" if they are.
  std::string problem() const;

 private:
  struct Reading {
    ros::Time stamp;
    UncertainPose pose;
  };
  void receive(const ros::MessageEvent<const sensor_msgs::LaserScan>& event);
  void receive_odometry(const nav_msgs::Odometry& message);
  void use_pending();
  std::optional<UncertainPose> odometry_at(ros::Time stamp) const;

  Frames frames_;
  std::function<void(const PlacedScan&)> use_;
  std::function<void(const nav_msgs::Odometry&)> odometry_;
  ScanWatch watch_;
  std::deque<Reading> readings_;
  std::optional<sensor_msgs::LaserScan> pending_;
  std::string base_frame_, place_problem_;
  double moved_ = 0;  // m + rad, by the odometry
  ros::Subscriber scan_, odom_;
};

}  // namespace robot_control
