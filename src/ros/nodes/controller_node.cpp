#include "ros/nodes/controller_node.h"

#include <ros/ros.h>

#include <atomic>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "files/ascii.h"
#include "loop/processes/controller_process.h"
#include "robots/wheeled/start_check.h"
#include "ros/inputs/command_input.h"
#include "ros/inputs/command_mux.h"
#include "ros/inputs/input_topic.h"
#include "ros/inputs/live_overrides.h"
#include "ros/inputs/reconfigure.h"
#include "ros/messages/motion_messages.h"
#include "ros/messages/tuning_messages.h"
#include "ros/network/graph.h"
#include "ros/nodes/process_node.h"
#include "ros/reports/command_report.h"
#include "ros/reports/diagnostics.h"
#include "ros/reports/pacer.h"
#include "ros/reports/reason_history.h"
#include "ros/reports/report_line.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

class ControllerNode final : public ProcessNode<ControllerProcess> {
 public:
  explicit ControllerNode(const Setup& setup)
      : ProcessNode(setup, Role::kController),
        input_(parameters().controller.cmd_vel_timeout, parameters().controller.one_sender),
        pace_(report().command_rate),
        command_report_(robot(), parameters().controller) {
    if (parameters().command_sources.empty()) return;
    list_ = read_command_sources(parameters().command_sources);
    mux_.emplace(list_, parameters().controller.cmd_vel_timeout, parameters().controller.one_sender);
    intake_ = &*mux_;
  }

  void connect(ros::NodeHandle& handle) override {
    expect_monitor();
    if (const std::string note = note_on_slow_driving(parameters(), robot()); !note.empty())
      ROS_INFO("%s", note.c_str());
    ros::NodeHandle own("~");
    set_parameters_ = own.advertiseService("set_parameters", &ControllerNode::set_parameters, this);
    set_parameter_map_ = own.advertiseService("set_parameter_map", &ControllerNode::set_parameter_map, this);
    descriptions_ = own.advertise<msg::ConfigDescription>("parameter_descriptions", 1, true);
    updates_ = own.advertise<msg::Config>("parameter_updates", 1, true);
    descriptions_.publish(description_of(process().retuner()->live()));
    updates_.publish(config_of(process().retuner()->live()));
    joint_commands_ = handle.advertise<msg::Float64MultiArray>("joint_commands", 10);
    joint_targets_ = handle.advertise<msg::JointState>("joint_targets", 10);
    velocity_out_ = handle.advertise<msg::TwistStamped>("cmd_vel_out", 10);
    drive_state_ = handle.advertise<msg::DriveState>("drive_state", 10);
    intake_->start(earlier_controller(handle));
    if (mux_) {
      connect_sources(handle);
      return;
    }
    cmd_vel_.connect_with_sender(handle, [this](const msg::Twist& message, const Publisher& sender) {
      receive({.sender = sender, .twist = twist_of(message)});
    });
    cmd_vel_stamped_.connect_with_sender(handle, [this](const msg::TwistStamped& message, const Publisher& sender) {
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
    SensorFrame sensors;
    if (process().sensors().newest(sensors) != Lookup::kFrame || !process().is_current(sensors.head)) return;
    look_at_senders();
    if (process().output().newest(command_) != Lookup::kFrame || command_.head.run != sensors.head.run) return;
    const FrameHead& head = command_.head;
    const std::uint64_t reasons = history_.collect(process().output(), command_);
    since_message_ |= reasons;
    since_report_ |= reasons;
    time().follow(sensors);
    if (!pace_.due(head.run, head.stamp_ns)) return;
    const ros::Time stamp = time().at(head.stamp_ns);
    joint_commands_.publish(joint_commands(command_, robot()));
    joint_targets_.publish(joint_targets(command_, robot(), stamp));
    velocity_out_.publish(velocity_out(command_, report().base_frame, stamp));
    msg::DriveState state = drive_state(command_, plan(), std::exchange(since_message_, 0), robot(), stamp);
    add_senders(state);
    drive_state_.publish(state);
    if (report_outdated_.exchange(false)) command_report_.limit(process().retuner()->in_force().controller);
    write_log(command_report_.update(command_));
  }

  void diagnose(DiagnosticReport& report) override {
    const std::lock_guard lock(input_mutex_);
    const std::uint64_t lately = std::exchange(since_report_, 0);
    report_command(report, command_, lately, intake_->senders(loop_ns()), intake_->states(), intake_->revoked());
  }

 private:
  /// Two topics call this from two threads; the mutex protects their common inbox.
  void receive(const ArrivedCommand& arrived) {
    const std::lock_guard lock(input_mutex_);
    log_dropped(arrived.sender.name);
    follow_permission();
    input_.receive(arrived, arrival_time());
    process().cycle().inbox().store(input_.value());
  }

  /// Receives a command of the source with index `source` of the list.
  void receive_from(std::size_t source, const ArrivedCommand& arrived) {
    const std::lock_guard lock(input_mutex_);
    log_dropped(arrived.sender.name);
    follow_permission();
    mux_->receive(source, arrived, arrival_time());
    process().cycle().inbox().store(mux_->value());
  }

  /// Returns true if the command in force ended. The caller holds input_mutex_.
  bool follow_permission() {
    Permit permit;
    if (process().permits().newest(permit) != Lookup::kFrame || !process().is_current(permit.head)) return false;
    return intake_->follow(motion_permission(permit), loop_ns());
  }

  /// Returns the present time on both clocks. The caller holds input_mutex_.
  ArrivalTime arrival_time() {
    const bool lockstep = parameters().loop.clock == ClockMode::kLockstep;
    ArrivalTime time{.ros_ns = 0, .loop_ns = loop_ns()};
    time.ros_ns = lockstep ? time.loop_ns : static_cast<std::int64_t>(ros::WallTime::now().toNSec());
    return time;
  }

  /// Returns the situation at the start. It is called before this node subscribes to a command topic and before its
  /// loop runs.
  EarlierController earlier_controller(ros::NodeHandle& handle) {
    std::vector<std::string> topics;
    for (const CommandSource& source : list_.sources) topics.push_back(handle.resolveName(source.topic));
    if (!mux_) topics = {handle.resolveName("cmd_vel"), handle.resolveName("cmd_vel_stamped")};
    EarlierController earlier;
    const Lookup found = process().output().last_whole(command_);
    if (found == Lookup::kFrame) earlier.run = command_.head.run;
    earlier.requested = found == Lookup::kFrame ? requests_motion(command_) : found == Lookup::kCorrupt;
    for (const std::string& node : publishers_of(topics, Unanswered::kRepeat))
      earlier.present.push_back({node, nullptr, uri_of(node)});
    return earlier;
  }

  void connect_sources(ros::NodeHandle& handle) {
    for (std::size_t i = 0; i < list_.sources.size(); ++i) {
      const std::string& topic = list_.sources[i].topic;
      if (list_.sources[i].stamped) {
        stamped_sources_.emplace_back(topic, 1).connect_with_sender(
            handle, [this, i](const msg::TwistStamped& message, const Publisher& sender) {
              const auto stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
              receive_from(i, {.sender = sender, .twist = twist_of(message.twist), .stamp_ns = stamp_ns});
            });
      } else {
        sources_.emplace_back(topic, 1).connect_with_sender(
            handle, [this, i](const msg::Twist& message, const Publisher& sender) {
              receive_from(i, {.sender = sender, .twist = twist_of(message)});
            });
      }
    }
    for (std::size_t i = 0; i < list_.locks.size(); ++i) {
      // A malformed message locks, too: its sender may have meant a lock.
      locks_.emplace_back(list_.locks[i].topic, 10)
          .connect(
              handle, [this, i](const msg::Bool& message) { receive_lock(i, message.data != 0); },
              [this, i] { receive_lock(i, true); });
    }
  }

  void receive_lock(std::size_t index, bool set) {
    const std::lock_guard lock(input_mutex_);
    mux_->receive_lock(index, set, loop_ns());
    process().cycle().inbox().store(mux_->value());
  }

  void add_senders(msg::DriveState& message) {
    const std::lock_guard lock(input_mutex_);
    message.commander = intake_->winner();
    const std::vector<std::string> states = intake_->states();
    message.sources.assign(states.begin(), states.end());
    const std::vector<std::string> revoked = intake_->revoked();
    message.revoked.assign(revoked.begin(), revoked.end());
  }

  /// A command that arrives before the loop runs has no effect later. This is reported once until the loop has run.
  void log_dropped(const std::string& sender) {
    SensorFrame sensors;
    CommandFrame command;
    const bool runs = process().sensors().newest(sensors) == Lookup::kFrame && process().is_current(sensors.head) &&
                      process().output().newest(command) == Lookup::kFrame && command.head.run == sensors.head.run;
    if (!runs && !dropped_reported_) {
      ROS_WARN(
          "a command of %s arrived before the loop runs and is dropped, as are all until it does; send it again "
          "when safety_status says READY",
          sender.c_str());
    }
    dropped_reported_ = !runs;
  }

  /// Returns the stamp of the newest sensor frame. The caller holds input_mutex_.
  std::int64_t loop_ns() {
    SensorFrame sensors;
    const bool found = process().sensors().newest(sensors) == Lookup::kFrame && process().is_current(sensors.head);
    if (found) loop_ns_ = sensors.head.stamp_ns;
    return loop_ns_;
  }

  /// Checks retuning against the monitor's parameters. A monitor whose parameters are refused does not start, so they
  /// need no check here.
  void expect_monitor() {
    try {
      process().retuner()->expect_monitor(parameters_of(Role::kMonitor));
    } catch (const ParameterError&) {
    }
  }

  bool set_parameter_map(msg::SetParametersRequest& request, msg::SetParametersResponse& response) {
    const Answer answer = retune(request.parameters);
    response.success = answer.accepted ? 1 : 0;
    response.message = ascii(answer.text);
    return true;
  }

  /// As dynamic_reconfigure requires, the response holds the values in force, whether the request was accepted or not.
  bool set_parameters(msg::ReconfigureRequest& request, msg::ReconfigureResponse& response) {
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
          "set_parameters refused, nothing is changed: another set is being taken, or waits for the ROS master; call "
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
    intake_->set_timeout(parameters.cmd_vel_timeout);
    report_outdated_.store(true);
  }

  void look_at_senders() {
    std::vector<ReportLine> lines;
    {
      const std::lock_guard lock(input_mutex_);
      const bool ended = follow_permission();
      if (intake_->update(loop_ns()) || ended) process().cycle().inbox().store(intake_->value());
      lines = intake_->lines();
    }
    write_log(lines);
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
  ros::Publisher velocity_out_;
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
  std::mutex input_mutex_;
  CommandInput input_;
  std::optional<CommandMux> mux_;    ///< present if there is a list of sources; then `input_` receives nothing
  CommandIntake* intake_ = &input_;  ///< `mux_` if it is present, else `input_`
  std::int64_t loop_ns_ = 0;
  bool dropped_reported_ = false;
  Pacer pace_;
  CommandReport command_report_;
  CommandFrame command_;
  ReasonHistory history_;
  std::uint64_t since_message_ = 0;  ///< CommandReason bits since the last drive_state
  std::uint64_t since_report_ = 0;   ///< CommandReason bits since the last /diagnostics
};

}  // namespace

std::unique_ptr<Node> make_controller(const Setup& setup) {
  return std::make_unique<ControllerNode>(setup);
}

}  // namespace robot_control
