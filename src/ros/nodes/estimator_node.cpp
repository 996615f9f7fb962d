#include "ros/nodes/estimator_node.h"

#include <robot_control/SetOdometry.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>

#include <mutex>
#include <utility>

#include "loop/processes/estimator_process.h"
#include "ros/inputs/odometry_request.h"
#include "ros/messages/motion_messages.h"
#include "ros/messages/service_answer.h"
#include "ros/nodes/process_node.h"
#include "ros/reports/diagnostics.h"
#include "ros/reports/pacer.h"
#include "rt/clock.h"

namespace robot_control {
namespace {

class EstimatorNode final : public ProcessNode<EstimatorProcess> {
 public:
  EstimatorNode(const Setup& setup, std::unique_ptr<EstimatorOutputs> outputs)
      : ProcessNode(setup, Role::kEstimator),
        outputs_(std::move(outputs)),
        joint_pace_(report().joint_states_rate),
        odom_pace_(report().odom_rate),
        imu_pace_(report().imu_data_rate) {}

  void connect(ros::NodeHandle& handle) override {
    joint_states_ = handle.advertise<sensor_msgs::JointState>("joint_states", 10);
    odom_ = handle.advertise<nav_msgs::Odometry>("odom", 10);
    imu_ = handle.advertise<sensor_msgs::Imu>("imu/data", 10);
    battery_ = handle.advertise<sensor_msgs::BatteryState>("battery_state", 1);
    // The name is relative, so that the frames of two robots in two namespaces do not mix.
    if (report().publish_tf) tf_ = handle.advertise<tf2_msgs::TFMessage>("tf", 100);
    reset_ = handle.advertiseService("reset_odometry", &EstimatorNode::reset_odometry, this);
    set_ = handle.advertiseService("set_odometry", &EstimatorNode::set_odometry, this);
    if (outputs_) outputs_->connect(handle);
    if (const std::string note = covariance_note(report()); !note.empty()) ROS_INFO("%s", note.c_str());
  }

  std::int64_t tick_ns() const override {
    return publish_tick_ns(parameters(), sensors_.head.stamp_ns, {&joint_pace_, &odom_pace_, &imu_pace_});
  }

  void publish() override {
    if (process().sensors().newest(sensors_) != Lookup::kFrame || !process().is_current(sensors_.head)) return;
    time().follow(sensors_);
    const bool estimated = process().output().newest(state_) == Lookup::kFrame && state_.head.run == sensors_.head.run;
    if (joint_pace_.due(sensors_.head.run, sensors_.head.stamp_ns)) {
      const StateFrame* const state = estimated ? &state_ : nullptr;
      joint_states_.publish(joint_states(sensors_, state, robot(), time().at(sensors_.head.stamp_ns)));
    }
    const bool battery_due = battery_pace_.due(sensors_.head.run, sensors_.head.stamp_ns);
    if (battery_due && (sensors_.valid & kValidBattery) != 0) {
      battery_.publish(battery_state(sensors_, time().at(sensors_.head.stamp_ns)));
    }
    if (!estimated) return;
    slip_lately_ |= state_.wheeled.slip;
    if (odom_pace_.due(state_.head.run, state_.head.stamp_ns)) publish_odometry();
    if (imu_pace_.due(state_.head.run, state_.head.stamp_ns)) publish_imu();
    if (outputs_) outputs_->keep(state_, monotonic_ns());
  }

  void diagnose(DiagnosticReport& report) override {
    report_state(report, state_, slip_lately_, programs());
    slip_lately_ = 0;
  }

  void stop() override {
    ProcessNode::stop();
    if (outputs_) outputs_->finish(state_);
  }

 private:
  void publish_odometry() {
    const ros::Time stamp = time().at(state_.head.stamp_ns);
    nav_msgs::Odometry message = odometry(state_, report().odom_frame, report().base_frame, stamp);
    state_covariances(report(), message);
    odom_.publish(message);
    if (outputs_) outputs_->publish(state_, stamp);
    if (!tf_) return;
    tf2_msgs::TFMessage transforms;
    transforms.transforms.push_back(transform(message));
    tf_.publish(transforms);
  }

  /// Publishes the samples from which this state descends; newer samples may already exist.
  void publish_imu() {
    SensorFrame sample;
    if (process().sensors().at(state_.head.run, state_.head.cycle, sample) != Lookup::kFrame) return;
    if (!has_imu_data(sample, state_)) return;
    imu_.publish(imu_data(sample, state_, robot(), parameters().estimator, parameters().loop.period(),
                          time().at(state_.head.stamp_ns)));
  }

  /// Requests this pose from the next cycle on. Returns "" or the reason of a refusal.
  std::string request_pose(const Vector3& pose) {
    const std::vector<std::string> missing = this->missing();
    if (!missing.empty()) return "not done: no sensors, " + missing.front() + " does not run";
    const std::lock_guard<std::mutex> one(requesting_);  // callbacks run in two threads
    process().cycle().request_pose(pose);
    return "";
  }

  bool reset_odometry(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
    const std::string refusal = request_pose({0, 0, 0});
    return answer(response, refusal.empty(), refusal.empty() ? "the pose is zero from the next cycle on" : refusal);
  }

  bool set_odometry(SetOdometry::Request& request, SetOdometry::Response& response) {
    const Vector3 requested{request.x, request.y, request.yaw};
    const std::string problem = odometry_problem(requested);
    const std::string refusal = problem.empty() ? request_pose(normalised(requested)) : "not done: " + problem;
    return answer(response, refusal.empty(), refusal.empty() ? taken_sentence(normalised(requested)) : refusal);
  }

  std::unique_ptr<EstimatorOutputs> outputs_;
  std::mutex requesting_;
  ros::Publisher joint_states_;
  ros::Publisher odom_;
  ros::Publisher imu_;
  ros::Publisher battery_;
  ros::Publisher tf_;
  ros::ServiceServer reset_;
  ros::ServiceServer set_;
  Pacer joint_pace_;
  Pacer odom_pace_;
  Pacer imu_pace_;
  Pacer battery_pace_{1};  ///< Hz
  SensorFrame sensors_;
  StateFrame state_;
  std::uint64_t slip_lately_ = 0;
};

}  // namespace

std::unique_ptr<Node> make_estimator(const Setup& setup, std::unique_ptr<EstimatorOutputs> outputs) {
  return std::make_unique<EstimatorNode>(setup, std::move(outputs));
}

}  // namespace robot_control
