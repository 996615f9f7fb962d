#pragma once
/// MapTopics publishes what slam and localization have in common: map, transform from map to odom, and state.

#include <nav_msgs/GetMap.h>
#include <nav_msgs/Odometry.h>
#include <robot_control/LocalizationState.h>
#include <ros/ros.h>

#include <string>

#include "navigation/grid.h"
#include "ros/reports/diagnostics.h"

namespace robot_control::navigation {

class MapTopics {
 public:
  explicit MapTopics(ros::NodeHandle& handle);

  /// Publishes `map` and `map_metadata`, latched; `static_map` answers with it.
  void publish(const Grid& grid);

  /// Publishes the transform from map to the frame of this odometry, with its stamp.
  void publish(const PlanarPose& correction, const nav_msgs::Odometry& odometry);

  /// Publishes `localization_state`, latched, if it differs from the last one; logs what is new.
  void publish(const std::string& state, const std::string& reason, double explained, ros::Time stamp);

  /// Reports the last state.
  void diagnose(DiagnosticReport& report) const;

 private:
  bool answer(nav_msgs::GetMap::Request& request, nav_msgs::GetMap::Response& response);

  ros::Publisher map_, metadata_, tf_, state_;
  ros::ServiceServer static_map_;
  nav_msgs::OccupancyGrid newest_;
  robot_control::LocalizationState last_;
};

}  // namespace robot_control::navigation
