#include "bridge/diff_drive_controller_node.h"

#include <ros/ros.h>

#include <mutex>

#include "bridge/command_report.h"
#include "bridge/diagnostics.h"
#include "bridge/input_topic.h"
#include "bridge/motion_messages.h"
#include "bridge/pacer.h"
#include "bridge/process_node.h"
#include "runtime/controller_process.h"

namespace robot_control {
namespace {

class DiffDriveControllerNode final : public ProcessNode<ControllerProcess> {
 public:
  explicit DiffDriveControllerNode(const Setup& setup)
      : ProcessNode(setup), pace_(report().command_rate), command_report_(robot(), parameters().controller) {}

  void connect(ros::NodeHandle& handle) override {
    joint_commands_ = handle.advertise<msg::Float64MultiArray>("joint_commands", 10);
    joint_targets_ = handle.advertise<msg::JointState>("joint_targets", 10);
    velocity_out_ = handle.advertise<msg::TwistStamped>("cmd_vel_out", 10);
    cmd_vel_.connect(handle, [this](const msg::Twist& message) { receive(message); });
    cmd_vel_stamped_.connect(handle, [this](const msg::TwistStamped& message) { receive(message.twist); });
  }

  std::int64_t tick_ns() const override { return publish_tick_ns(parameters(), {report().command_rate}); }

  void publish() override {
    SensorFrame sensors;
    if (process().sensors().newest(sensors) != Lookup::kFrame || !process().is_current(sensors.head)) return;
    if (process().output().newest(command_) != Lookup::kFrame || command_.head.run != sensors.head.run) return;
    const FrameHead& head = command_.head;
    time().follow(sensors);
    if (!pace_.due(head.run, head.stamp_ns)) return;
    const ros::Time stamp = time().at(head.stamp_ns);
    joint_commands_.publish(joint_commands(command_, robot()));
    joint_targets_.publish(joint_targets(command_, robot(), stamp));
    velocity_out_.publish(velocity_out(command_, report().base_frame, stamp));
    tell();
  }

  void diagnose(DiagnosticReport& report) override { report_command(report, command_); }

 private:
  /// Two topics, two threads, one inbox.
  void receive(const msg::Twist& message) {
    const std::lock_guard lock(received_mutex_);
    received_.twist = twist_of(message);
    ++received_.count;
    process().cycle().inbox().store(received_);
  }

  void tell() {
    for (const ReportLine& line : command_report_.look(command_)) {
      if (line.warning) {
        ROS_WARN("%s", line.text.c_str());
      } else {
        ROS_INFO("%s", line.text.c_str());
      }
    }
  }

  ros::Publisher joint_commands_;
  ros::Publisher joint_targets_;
  ros::Publisher velocity_out_;
  InputTopic<BoundedTwist> cmd_vel_{"cmd_vel", 1};
  InputTopic<BoundedTwistStamped> cmd_vel_stamped_{"cmd_vel_stamped", 1};
  std::mutex received_mutex_;
  VelocityCommand received_;
  Pacer pace_;
  CommandReport command_report_;
  CommandFrame command_;
};

}  // namespace

std::unique_ptr<Node> make_diff_drive_controller(const Setup& setup) {
  return std::make_unique<DiffDriveControllerNode>(setup);
}

}  // namespace robot_control
