#include "ros/navigation/goal_servers.h"

#include "ros/navigation/navigation_messages.h"

namespace robot_control::navigation {
namespace {

constexpr const char* kReplaced = "replaced by a newer goal";

/// actionlib calls a preempt callback before each new goal, too, which is no cancellation.
template <class Server>
void register_cancel(Server& server, const std::function<void()>& cancel) {
  server.registerPreemptCallback([&server, cancel] {
    if (!server.isNewGoalAvailable()) cancel();
  });
}

}  // namespace

GoalServers::GoalServers(ros::NodeHandle& handle, std::function<void(const Goal&)> begin, std::function<void()> cancel)
    : begin_(std::move(begin)), navigate_to_(handle, "navigate_to", false), move_base_(handle, "move_base", false) {
  navigate_to_.registerGoalCallback([this] { accept_navigate_to(); });
  move_base_.registerGoalCallback([this] { accept_move_base(); });
  register_cancel(navigate_to_, cancel);
  register_cancel(move_base_, cancel);
  navigate_to_.start();
  move_base_.start();
  simple_ = handle.advertise<move_base_msgs::MoveBaseActionGoal>("move_base/goal", 1);
  simple_goal_.connect(handle, [this](const geometry_msgs::PoseStamped& pose) {
    move_base_msgs::MoveBaseActionGoal goal;
    goal.header.stamp = ros::Time::now();
    goal.goal.target_pose = pose;
    simple_.publish(goal);
  });
}

void GoalServers::accept_navigate_to() {
  if (!navigate_to_.isNewGoalAvailable()) return;
  conclude(false, true, kReplaced);
  const auto goal = navigate_to_.acceptNewGoal();
  begin_({goal->target, goal->speed});
}

void GoalServers::accept_move_base() {
  if (!move_base_.isNewGoalAvailable()) return;
  conclude(false, true, kReplaced);
  const auto goal = move_base_.acceptNewGoal();
  begin_({goal->target_pose, 0});
}

void GoalServers::feedback(const NavigatorOutput& output, const PlanarPose& pose, const std::string& map_frame) {
  if (navigate_to_.isActive()) {
    NavigateToFeedback message;
    message.state = name_of(output.state);
    message.reason = output.reason;
    message.remaining_distance = output.remaining;
    navigate_to_.publishFeedback(message);
  }
  if (move_base_.isActive()) {
    move_base_msgs::MoveBaseFeedback message;
    message.base_position.header.stamp = ros::Time::now();
    message.base_position.header.frame_id = map_frame;
    message.base_position.pose = pose_message(pose);
    move_base_.publishFeedback(message);
  }
}

template <class Server>
void GoalServers::finish(Server& server, const typename Server::Result& result, bool reached, bool cancelled,
                         const std::string& reason) {
  if (!server.isActive()) return;
  if (reached) {
    server.setSucceeded(result, reason);
  } else if (cancelled) {
    server.setPreempted(result, reason);
  } else {
    server.setAborted(result, reason);
  }
}

void GoalServers::conclude(bool reached, bool cancelled, const std::string& reason) {
  NavigateToResult result;
  result.reason = reason;
  finish(navigate_to_, result, reached, cancelled, reason);
  finish(move_base_, move_base_msgs::MoveBaseResult(), reached, cancelled, reason);
}

}  // namespace robot_control::navigation
