#pragma once
/// The actions that bring the robot to poses. The newest goal of any of them counts and ends the one before.

#include <actionlib/server/simple_action_server.h>
#include <move_base_msgs/MoveBaseAction.h>
#include <robot_control/NavigateThroughAction.h>
#include <robot_control/NavigateToAction.h>
#include <ros/ros.h>

#include <functional>
#include <string>
#include <vector>

#include "navigation/goals/navigator.h"
#include "ros/navigation/bounded_inputs.h"

namespace robot_control::navigation {

class GoalServers {
 public:
  struct Goal {
    std::vector<geometry_msgs::PoseStamped> targets;  ///< one after the other
    double speed = 0;                                 ///< m/s; 0: the node's own
  };

  /// `begin` is called for each goal that arrives, `cancel` if the present one is cancelled.
  GoalServers(ros::NodeHandle& handle, std::function<void(const Goal&)> begin, std::function<void()> cancel);

  /// `pose` is that of the robot now.
  void feedback(const NavigatorOutput& output, const geometry_msgs::PoseStamped& pose);

  /// Notes that the present target is reached.
  void reach(const geometry_msgs::PoseStamped& pose) { reached_.push_back(pose); }

  /// Ends the present goal; `cancelled` if its client did so.
  void conclude(bool reached, bool cancelled, const std::string& reason);

 private:
  template <class Action>
  using Server = actionlib::SimpleActionServer<Action>;

  template <class Action, class Read>
  void serve(Server<Action>& server, Read read);

  std::function<void(const Goal&)> begin_;
  std::function<void()> cancel_;
  Server<NavigateToAction> navigate_to_;
  Server<NavigateThroughAction> navigate_through_;
  Server<move_base_msgs::MoveBaseAction> move_base_;
  std::vector<geometry_msgs::PoseStamped> reached_;  // of the present goal
  ros::Publisher simple_;
  InputTopic<BoundedPoseStamped> simple_goal_{"move_base_simple/goal", 1};
};

}  // namespace robot_control::navigation
