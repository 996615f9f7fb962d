#include "ros/navigation/path_client.h"

#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatus.h>
#include <geometry_msgs/TwistStamped.h>
#include <robot_control/FollowPathActionGoal.h>

#include "ros/navigation/navigation_messages.h"

namespace robot_control::navigation {

PathClient::PathClient(ros::NodeHandle& handle)
    : goal_(handle.advertise<FollowPathActionGoal>("follow_path/goal", 10)),
      cancel_(handle.advertise<actionlib_msgs::GoalID>("follow_path/cancel", 10, true)),
      velocity_(handle.advertise<geometry_msgs::TwistStamped>("follow_path/velocity", 1)) {
  feedback_.connect(handle, [this](const FollowPathActionFeedback& message) { receive_feedback(message); });
  result_.connect(handle, [this](const FollowPathActionResult& message) { receive_result(message); });
  actionlib_msgs::GoalID before_now;
  before_now.stamp = ros::Time::now();
  cancel_.publish(before_now);
}

void PathClient::send(const Plan& plan, const std::string& frame, double speed, bool steered, ros::Time requested) {
  FollowPathActionGoal message;
  id_ = ros::this_node::getName() + "-" + std::to_string(ros::Time::now().toNSec()) + "-" + std::to_string(++sent_);
  message.header.stamp = ros::Time::now();
  message.goal_id.id = id_;
  message.goal_id.stamp = requested;
  message.goal.speed = speed;
  message.goal.steered = steered;
  message.goal.path.header.frame_id = frame;
  message.goal.path.header.stamp = message.header.stamp;
  for (const PlanarPose& pose : plan.poses) {
    geometry_msgs::PoseStamped stamped;
    stamped.header = message.goal.path.header;
    stamped.pose = pose_message(pose);
    message.goal.path.poses.push_back(stamped);
  }
  goal_.publish(message);
  reason_.clear();
  report_ = {PathReport::State::kActive, ""};
}

void PathClient::steer(const PlanarMotion& motion) {
  geometry_msgs::TwistStamped message;
  message.header.stamp = ros::Time::now();
  message.twist.linear.x = motion.linear;
  message.twist.linear.y = motion.lateral;
  message.twist.angular.z = motion.angular;
  velocity_.publish(message);
}

void PathClient::cancel() {
  actionlib_msgs::GoalID message;
  message.id = id_;
  if (!id_.empty()) cancel_.publish(message);
  report_ = {};
}

void PathClient::receive_feedback(const FollowPathActionFeedback& message) {
  if (message.status.goal_id.id != id_ || !driving()) return;
  reason_ = message.feedback.reason;
  report_.state = message.feedback.state == "paused" ? PathReport::State::kPaused : PathReport::State::kActive;
}

void PathClient::receive_result(const FollowPathActionResult& message) {
  if (message.status.goal_id.id != id_ || !driving()) return;
  const bool done = message.status.status == actionlib_msgs::GoalStatus::SUCCEEDED;
  report_ = {done ? PathReport::State::kDone : PathReport::State::kFailed, message.result.reason};
}

}  // namespace robot_control::navigation
