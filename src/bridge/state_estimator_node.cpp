#include "bridge/state_estimator_node.h"

#include <ros/ros.h>

#include "bridge/diagnostics.h"
#include "bridge/motion_messages.h"
#include "bridge/pacer.h"
#include "bridge/process_node.h"
#include "runtime/estimator_process.h"

namespace robot_control {
namespace {

class StateEstimatorNode final : public ProcessNode<EstimatorProcess> {
 public:
  explicit StateEstimatorNode(const Setup& setup)
      : ProcessNode(setup), joint_pace_(report().joint_states_rate), odom_pace_(report().odom_rate) {}

  void connect(ros::NodeHandle& handle) override {
    joint_states_ = handle.advertise<msg::JointState>("joint_states", 10);
    odom_ = handle.advertise<msg::Odometry>("odom", 10);
    // Relative, so that the frames of a second robot in a namespace do not mix with the first one's.
    if (report().publish_tf) tf_ = handle.advertise<msg::TFMessage>("tf", 100);
    reset_ = handle.advertiseService("reset_odometry", &StateEstimatorNode::reset_odometry, this);
  }

  std::int64_t tick_ns() const override {
    return publish_tick_ns(parameters(), {report().joint_states_rate, report().odom_rate});
  }

  void publish() override {
    if (process().sensors().newest(sensors_) != Lookup::kFrame || !process().is_current(sensors_.head)) return;
    time().follow(sensors_);
    if (joint_pace_.due(sensors_.head.run, sensors_.head.stamp_ns)) {
      joint_states_.publish(joint_states(sensors_, robot(), time().at(sensors_.head.stamp_ns)));
    }
    if (process().output().newest(state_) != Lookup::kFrame || state_.head.run != sensors_.head.run) return;
    if (odom_pace_.due(state_.head.run, state_.head.stamp_ns)) publish_odometry();
  }

  void diagnose(DiagnosticReport& report) override { report_state(report, state_); }

 private:
  void publish_odometry() {
    const msg::Odometry message =
        odometry(state_, report().odom_frame, report().base_frame, time().at(state_.head.stamp_ns));
    odom_.publish(message);
    if (!tf_) return;
    msg::TFMessage transforms;
    transforms.transforms.push_back(transform(message));
    tf_.publish(transforms);
  }

  bool reset_odometry(msg::TriggerRequest& /*request*/, msg::TriggerResponse& response) {
    const std::vector<std::string> missing = this->missing();
    response.success = missing.empty();
    response.message = response.success ? "the pose is zero from the next cycle on"
                                        : "not done: no sensors, " + missing.front() + " does not run";
    if (response.success) process().cycle().request_pose({0, 0, 0});
    return true;
  }

  ros::Publisher joint_states_;
  ros::Publisher odom_;
  ros::Publisher tf_;
  ros::ServiceServer reset_;
  Pacer joint_pace_;
  Pacer odom_pace_;
  SensorFrame sensors_;
  StateFrame state_;
};

}  // namespace

std::unique_ptr<Node> make_state_estimator(const Setup& setup) {
  return std::make_unique<StateEstimatorNode>(setup);
}

}  // namespace robot_control
