#pragma once
/// The two actions that bring the robot to a pose. The newest goal of either counts and ends the one before.

#include <actionlib/server/simple_action_server.h>
#include <move_base_msgs/MoveBaseAction.h>
#include <robot_control/NavigateToAction.h>
#include <ros/ros.h>

#include <functional>
#include <string>

#include "navigation/navigator.h"
#include "ros/navigation/bounded_inputs.h"

namespace robot_control::navigation {

class GoalServers {
 public:
  struct Goal {
    geometry_msgs::PoseStamped target;
    double speed = 0;  ///< m/s; 0: the node's own
  };

  /// `begin` is called for each goal that arrives, `cancel` where the present one is cancelled.
  GoalServers(ros::NodeHandle& handle, std::function<void(const Goal&)> begin, std::function<void()> cancel);

  void feedback(const NavigatorOutput& output, const PlanarPose& pose, const std::string& map_frame);

  /// Ends the present goal; `cancelled` where its client did so.
  void conclude(bool reached, bool cancelled, const std::string& reason);

 private:
  template <class Server>
  void finish(Server& server, const typename Server::Result& result, bool reached, bool cancelled,
              const std::string& reason);

  using NavigateTo = actionlib::SimpleActionServer<NavigateToAction>;
  using MoveBase = actionlib::SimpleActionServer<move_base_msgs::MoveBaseAction>;

  void accept_navigate_to();
  void accept_move_base();

  std::function<void(const Goal&)> begin_;
  NavigateTo navigate_to_;
  MoveBase move_base_;
  ros::Publisher simple_;
  InputTopic<BoundedPoseStamped> simple_goal_{"move_base_simple/goal", 1};
};

}  // namespace robot_control::navigation
