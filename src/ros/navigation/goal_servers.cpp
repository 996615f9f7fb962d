#include "ros/navigation/goal_servers.h"

namespace robot_control::navigation {
namespace {

constexpr const char* kReplaced = "replaced by a newer goal";

template <class Server, class Result>
void finish(Server& server, const Result& result, bool reached, bool cancelled, const std::string& reason) {
  if (!server.isActive()) return;
  if (reached) {
    server.setSucceeded(result, reason);
  } else if (cancelled) {
    server.setPreempted(result, reason);
  } else {
    server.setAborted(result, reason);
  }
}

template <class Feedback>
Feedback feedback_of(const NavigatorOutput& output) {
  Feedback message;
  message.state = name_of(output.state);
  message.reason = output.reason;
  message.remaining_distance = output.remaining;
  return message;
}

}  // namespace

GoalServers::GoalServers(ros::NodeHandle& handle, std::function<void(const Goal&)> begin, std::function<void()> cancel)
    : begin_(std::move(begin)),
      cancel_(std::move(cancel)),
      navigate_to_(handle, "navigate_to", false),
      navigate_through_(handle, "navigate_through", false),
      move_base_(handle, "move_base", false) {
  serve(navigate_to_, [](const NavigateToGoal& goal) { return Goal{{goal.target}, goal.speed}; });
  serve(navigate_through_, [](const NavigateThroughGoal& goal) { return Goal{goal.waypoints, goal.speed}; });
  serve(move_base_, [](const move_base_msgs::MoveBaseGoal& goal) { return Goal{{goal.target_pose}, 0}; });
  simple_ = handle.advertise<move_base_msgs::MoveBaseActionGoal>("move_base/goal", 1);
  simple_goal_.connect(handle, [this](const geometry_msgs::PoseStamped& pose) {
    move_base_msgs::MoveBaseActionGoal goal;
    goal.header.stamp = ros::Time::now();
    goal.goal.target_pose = pose;
    simple_.publish(goal);
  });
}

/// Begins each new goal after the end of the present one. actionlib also calls the preempt callback before a new goal,
/// which is no cancellation.
template <class Action, class Read>
void GoalServers::serve(Server<Action>& server, Read read) {
  server.registerGoalCallback([this, &server, read] {
    if (!server.isNewGoalAvailable()) return;
    conclude(false, true, kReplaced);
    begin_(read(*server.acceptNewGoal()));
  });
  server.registerPreemptCallback([this, &server] {
    if (!server.isNewGoalAvailable()) cancel_();
  });
  server.start();
}

void GoalServers::feedback(const NavigatorOutput& output, const geometry_msgs::PoseStamped& pose) {
  if (navigate_to_.isActive()) navigate_to_.publishFeedback(feedback_of<NavigateToFeedback>(output));
  if (navigate_through_.isActive()) {
    auto message = feedback_of<NavigateThroughFeedback>(output);
    message.index = static_cast<std::uint32_t>(reached_.size());
    navigate_through_.publishFeedback(message);
  }
  if (move_base_.isActive()) {
    move_base_msgs::MoveBaseFeedback message;
    message.base_position = pose;
    move_base_.publishFeedback(message);
  }
}

void GoalServers::conclude(bool reached, bool cancelled, const std::string& reason) {
  NavigateToResult result;
  result.reason = reason;
  NavigateThroughResult through;
  through.reason = reason;
  through.reached = std::exchange(reached_, {});
  finish(navigate_to_, result, reached, cancelled, reason);
  finish(navigate_through_, through, reached, cancelled, reason);
  finish(move_base_, move_base_msgs::MoveBaseResult(), reached, cancelled, reason);
}

}  // namespace robot_control::navigation
