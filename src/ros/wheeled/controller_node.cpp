#include "ros/wheeled/controller_node.h"

#include <dynamic_reconfigure/Reconfigure.h>
#include <robot_control/SetParameters.h>
#include <ros/ros.h>

#include <atomic>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "robots/wheeled/start_check.h"
#include "ros/inputs/command_input.h"
#include "ros/inputs/command_mux.h"
#include "ros/inputs/input_topic.h"
#include "ros/inputs/reconfigure.h"
#include "ros/messages/motion_messages.h"
#include "ros/messages/service_answer.h"
#include "ros/nodes/commanded_node.h"
#include "ros/reports/diagnostics.h"
#include "ros/reports/pacer.h"
#include "ros/reports/report_line.h"
#include "ros/wheeled/command_report.h"
#include "ros/wheeled/wheel_messages.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

class ControllerNode final : public CommandedNode {
 public:
  explicit ControllerNode(const Setup& setup)
      : CommandedNode(setup, input_),
        input_(parameters().controller.cmd_vel_timeout, parameters().controller.one_sender),
        pace_(report().command_rate),
        command_report_(drive_train_of(robot()), parameters().controller) {
    if (parameters().command_sources.empty()) return;
    list_ = read_command_sources(parameters().command_sources);
    mux_.emplace(list_, parameters().controller.cmd_vel_timeout, parameters().controller.one_sender);
    use(*mux_);
  }

  void connect(ros::NodeHandle& handle) override {
    expect_monitor();
    if (const std::string note = note_on_slow_driving(parameters(), wheels()); !note.empty())
      ROS_INFO("%s", note.c_str());
    ros::NodeHandle own("~");
    set_parameters_ = own.advertiseService("set_parameters", &ControllerNode::set_parameters, this);
    set_parameter_map_ = own.advertiseService("set_parameter_map", &ControllerNode::set_parameter_map, this);
    descriptions_ = own.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true);
    updates_ = own.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true);
    descriptions_.publish(description_of(process().retuner()->live()));
    updates_.publish(config_of(process().retuner()->live()));
    joint_commands_ = handle.advertise<std_msgs::Float64MultiArray>("joint_commands", 10);
    joint_targets_ = handle.advertise<sensor_msgs::JointState>("joint_targets", 10);
    velocity_out_ = handle.advertise<geometry_msgs::TwistStamped>("cmd_vel_out", 10);
    velocity_requested_ = handle.advertise<geometry_msgs::TwistStamped>("cmd_vel_requested", 10);
    drive_state_ = handle.advertise<DriveState>("drive_state", 10);
    intake().start(earlier_controller(handle, command_topics()));
    if (mux_) {
      connect_sources(handle);
      return;
    }
    cmd_vel_.connect_with_sender(handle, [this](const geometry_msgs::Twist& message, const Publisher& sender) {
      receive({.sender = sender, .twist = twist_of(message)});
    });
    cmd_vel_stamped_.connect_with_sender(
        handle, [this](const geometry_msgs::TwistStamped& message, const Publisher& sender) {
          const auto stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
          receive({.sender = sender, .twist = twist_of(message.twist), .stamp_ns = stamp_ns});
        });
  }

  /// It ends before the channel has overwritten a frame with its reasons.
  std::int64_t tick_ns() const override {
    const std::int64_t kept_ns = static_cast<std::int64_t>(kFrameSlots) / 2 * parameters().loop.period_ns();
    return std::min(kept_ns, publish_tick_ns(parameters(), command_.head.stamp_ns, {&pace_}));
  }

  void publish() override {
    if (!follow_command() || !pace_.due(command_.head.run, command_.head.stamp_ns)) return;
    const FrameHead& head = command_.head;
    const ros::Time stamp = time().at(head.stamp_ns);
    joint_commands_.publish(joint_commands(command_, wheels()));
    joint_targets_.publish(joint_targets(command_, wheels(), stamp));
    velocity_out_.publish(velocity_out(command_, report().base_frame, stamp));
    velocity_requested_.publish(velocity_requested(command_, report().base_frame, stamp));
    DriveState state = drive_state(command_, plan(), std::exchange(since_message_, 0), wheels(), stamp);
    add_senders(state);
    drive_state_.publish(state);
    if (report_outdated_.exchange(false)) command_report_.limit(process().retuner()->in_force().controller);
    write_log(command_report_.update(command_));
  }

  void diagnose(DiagnosticReport& report) override {
    const std::lock_guard lock(input_mutex_);
    report_command(report, command_, std::exchange(since_report_, 0), programs(), intake().senders(loop_ns()),
                   intake().states(), intake().revoked());
  }

 private:
  const DriveTrain& wheels() const { return drive_train_of(robot()); }

  std::vector<std::string> command_topics() const {
    if (!mux_) return {"cmd_vel", "cmd_vel_stamped"};
    std::vector<std::string> topics;
    for (const CommandSource& source : list_.sources) topics.push_back(source.topic);
    return topics;
  }

  /// Two topics call this from two threads; the mutex protects their common inbox.
  void receive(const ArrivedCommand& arrived) {
    const std::lock_guard lock(input_mutex_);
    input_.receive(arrived, arrival_of(arrived.sender.name));
    store();
  }

  /// Receives a command of the source with index `source` of the list.
  void receive_from(std::size_t source, const ArrivedCommand& arrived) {
    const std::lock_guard lock(input_mutex_);
    mux_->receive(source, arrived, arrival_of(arrived.sender.name));
    store();
  }

  void connect_sources(ros::NodeHandle& handle) {
    for (std::size_t i = 0; i < list_.sources.size(); ++i) {
      const std::string& topic = list_.sources[i].topic;
      if (list_.sources[i].stamped) {
        stamped_sources_.emplace_back(topic, 1).connect_with_sender(
            handle, [this, i](const geometry_msgs::TwistStamped& message, const Publisher& sender) {
              const auto stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
              receive_from(i, {.sender = sender, .twist = twist_of(message.twist), .stamp_ns = stamp_ns});
            });
      } else {
        sources_.emplace_back(topic, 1).connect_with_sender(
            handle, [this, i](const geometry_msgs::Twist& message, const Publisher& sender) {
              receive_from(i, {.sender = sender, .twist = twist_of(message)});
            });
      }
    }
    for (std::size_t i = 0; i < list_.locks.size(); ++i) {
      // A malformed message locks, too: its sender may have meant a lock.
      locks_.emplace_back(list_.locks[i].topic, 10)
          .connect(
              handle, [this, i](const std_msgs::Bool& message) { receive_lock(i, message.data != 0); },
              [this, i] { receive_lock(i, true); });
    }
  }

  void receive_lock(std::size_t index, bool set) {
    const std::lock_guard lock(input_mutex_);
    mux_->receive_lock(index, set, loop_ns());
    store();
  }

  void add_senders(DriveState& message) {
    const std::lock_guard lock(input_mutex_);
    message.commander = intake().winner();
    message.sources = intake().states();
    message.revoked = intake().revoked();
  }

  /// Checks retuning against the monitor's parameters. A monitor whose parameters are refused does not start, so they
  /// need no check here.
  void expect_monitor() {
    try {
      process().retuner()->expect_monitor(parameters_of(Role::kMonitor));
    } catch (const ParameterError&) {
    }
  }

  bool set_parameter_map(SetParameters::Request& request, SetParameters::Response& response) {
    const Answer retuned = retune(request.parameters);
    return answer(response, retuned.accepted, retuned.text);
  }

  /// As dynamic_reconfigure requires, the response holds the values in force, whether the request was accepted or not.
  bool set_parameters(dynamic_reconfigure::Reconfigure::Request& request,
                      dynamic_reconfigure::Reconfigure::Response& response) {
    const std::string text = request_text(request.config, process().retuner()->live());
    if (!text.empty()) retune(text);
    response.config = config_of(process().retuner()->live());
    return true;
  }

  struct Answer {
    bool accepted = false;
    std::string text;
  };

  /// Accepts the whole set of values or refuses it, and logs which.
  Answer retune(const std::string& request) {
    // Only one set is applied at a time, so that the server holds the set that was applied last. A second caller does
    // not wait: the master may hang, and a callback thread must stay free for commands.
    const std::unique_lock lock(tuning_mutex_, std::try_to_lock);
    Answer answer;
    if (!lock) {
      answer.text =
          "set_parameters refused, nothing is changed: another change is in progress, or waits for the ROS master; "
          "call "
          "again";
      ROS_WARN("%s", answer.text.c_str());
      return answer;
    }
    try {
      const Retuned retuned = process().retuner()->set(request);
      follow(process().retuner()->in_force().controller);
      updates_.publish(config_of(process().retuner()->live()));
      const std::string unwritten = write_overrides(retuned.values);
      answer = {.accepted = true, .text = sentence(retuned) + (unwritten.empty() ? "" : "; " + unwritten)};
      ROS_INFO("set_parameters: %s", answer.text.c_str());
    } catch (const ParameterError& error) {
      answer.text = error.what();
      ROS_WARN("%s", answer.text.c_str());
    }
    return answer;
  }

  /// Gives the new limits to the parts of this node that use them beside the controller.
  void follow(const DriveControllerParameters& parameters) {
    const std::lock_guard lock(input_mutex_);
    intake().set_timeout(parameters.cmd_vel_timeout);
    report_outdated_.store(true);
  }

  /// Returns the command of two cycles ago, which planned the present motion of the wheels. Returns an empty command if
  /// that one is not available.
  CommandFrame plan() {
    CommandFrame plan;
    const FrameHead& head = command_.head;
    const bool found = head.cycle >= 2 && process().output().at(head.run, head.cycle - 2, plan) == Lookup::kFrame;
    return found ? plan : CommandFrame{};
  }

  ros::Publisher joint_commands_;
  ros::Publisher joint_targets_;
  ros::Publisher velocity_out_, velocity_requested_;
  InputTopic<BoundedTwist> cmd_vel_{"cmd_vel", 1};
  InputTopic<BoundedTwistStamped> cmd_vel_stamped_{"cmd_vel_stamped", 1};
  CommandSourceList list_;
  std::deque<InputTopic<BoundedTwist>> sources_;
  std::deque<InputTopic<BoundedTwistStamped>> stamped_sources_;
  std::deque<InputTopic<BoundedBool>> locks_;
  ros::Publisher drive_state_;
  ros::ServiceServer set_parameters_;
  ros::ServiceServer set_parameter_map_;
  ros::Publisher descriptions_;
  ros::Publisher updates_;
  std::mutex tuning_mutex_;                   ///< protects the application of one set; locked only by try_lock
  std::atomic<bool> report_outdated_{false};  ///< `command_report_` still holds earlier limits
  CommandInput input_;
  std::optional<CommandMux> mux_;  ///< present if there is a list of sources; then `input_` receives nothing
  Pacer pace_;
  CommandReport command_report_;
};

}  // namespace

std::unique_ptr<Node> make_controller(const Setup& setup) {
  return std::make_unique<ControllerNode>(setup);
}

}  // namespace robot_control
