#pragma once
/// Sends paths to the action follow_path, and velocities that it drives in place of them.
///
/// Each goal bears the time at which the place was requested, not that of its planning. follow_path therefore refuses
/// what a stop has revoked since.

#include <string>

#include "navigation/goals/navigator.h"
#include "ros/navigation/bounded_inputs.h"

namespace robot_control::navigation {

class PathClient {
 public:
  /// Cancels what follow_path was sent before: a navigate that ended while it drove has left its path.
  explicit PathClient(ros::NodeHandle& handle);

  /// `frame` is that of the poses, `speed` in m/s. A `steered` path is only shown: `steer` drives.
  void send(const Plan& plan, const std::string& frame, double speed, bool steered, ros::Time requested);
  void steer(const PlanarMotion& motion);
  void cancel();

  const PathReport& report() const noexcept { return report_; }

  /// Returns why follow_path holds the robot, as it says; "" if it does not.
  std::string reason() const { return reason_; }

  bool connected() const { return goal_.getNumSubscribers() > 0; }

 private:
  bool driving() const noexcept {
    return report_.state == PathReport::State::kActive || report_.state == PathReport::State::kPaused;
  }
  void receive_feedback(const FollowPathActionFeedback& message);
  void receive_result(const FollowPathActionResult& message);

  ros::Publisher goal_, cancel_, velocity_;
  InputTopic<BoundedFollowPathActionFeedback> feedback_{"follow_path/feedback", 10};
  InputTopic<BoundedFollowPathActionResult> result_{"follow_path/result", 10};
  std::string id_, reason_;
  PathReport report_;
  int sent_ = 0;
};

}  // namespace robot_control::navigation
