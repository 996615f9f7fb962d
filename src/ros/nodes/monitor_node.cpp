#include "ros/nodes/monitor_node.h"

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <mutex>

#include "configuration/command_sources.h"
#include "files/ascii.h"
#include "loop/processes/monitor_process.h"
#include "ros/inputs/clearance_stream.h"
#include "ros/inputs/e_stop_levels.h"
#include "ros/inputs/input_topic.h"
#include "ros/messages/service_answer.h"
#include "ros/messages/status_messages.h"
#include "ros/network/graph.h"
#include "ros/nodes/process_node.h"
#include "ros/reports/diagnostics.h"
#include "ros/reports/stop_log.h"
#include "ros/reports/withdrawal_time.h"
#include "rt/clock.h"
#include "rt/futex.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

constexpr std::int64_t kStatusPeriod = 1'000'000'000;  // ns, at most, between two messages
constexpr std::int64_t kStatusGap = 20'000'000;        // ns, at least: a flickering cause does not flood subscribers
constexpr std::int64_t kTriggerWait = 500'000'000;     // ns; the other callback thread still receives the topic e_stop
constexpr std::int64_t kResetWait = 1'000'000'000;     // ns
constexpr std::int64_t kResetLook = 2'000'000;         // ns

class MonitorNode final : public ProcessNode<MonitorProcess> {
 public:
  explicit MonitorNode(const Setup& setup) : ProcessNode(setup, Role::kMonitor) {}

  void connect(ros::NodeHandle& handle) override {
    for (const std::string& topic : command_topics()) command_topics_.push_back(handle.resolveName(topic));
    status_ = handle.advertise<SafetyStatus>("safety_status", 10, true);
    e_stop_topic_ = handle.resolveName("e_stop");
    if (process().e_stop_restored()) hold_e_stop();
    // A malformed message stops the robot, too: its sender may have meant a stop.
    e_stop_.connect_with_sender(
        handle,
        [this](const std_msgs::Bool& message, const Publisher& sender) {
          receive_e_stop(sender.name, message.data != 0);
        },
        [this](const std::string& sender) { receive_e_stop(sender, true); });
    heartbeat_.connect(handle, [this](const std_msgs::Empty&) { add(&OperatorInput::heartbeats); });
    clearance_.connect(handle, [this](const std_msgs::Float64& message) { receive_clearance(message.data); });
    trigger_ = handle.advertiseService("e_stop_trigger", &MonitorNode::trigger, this);
    reset_ = handle.advertiseService("e_stop_reset", &MonitorNode::reset, this);
    if (!process().restored().empty()) ROS_WARN("%s", process().restored().c_str());
  }

  std::int64_t tick_ns() const override { return publish_tick_ns(parameters(), 0, {}); }

  void publish() override {
    const std::int64_t now_ns = monotonic_ns();
    check_clearance(now_ns);
    Permit permit;
    const bool found = seen(permit);
    if (found) withdrawal_.update(permit, now_ns);
    const std::vector<std::string> absent = missing();
    const bool changed =
        found != reported_permit_ || absent != reported_missing_ || (found && differs(reported_, permit));
    const std::int64_t silence_ns = now_ns - reported_ns_;
    if (reported_ns_ != 0 && silence_ns < (changed ? kStatusGap : kStatusPeriod)) return;
    SensorFrame sensors;
    const bool measured = live(sensors);
    if (measured) time().follow(sensors);
    SafetyStatus status =
        found ? safety_status(permit, robot(), absent, time(), parameters().loop.period_ns(), programs())
              : waiting_status(absent);
    if (const auto last_ns = withdrawal_.last_ns()) {
      status.withdrawn =
          ros::Time().fromNSec(ros::WallTime::now().toNSec() - static_cast<std::uint64_t>(now_ns - *last_ns));
    }
    note_latch_file(status);
    if (measured) warn_of_blind_conditions(sensors, status);
    status_.publish(status);
    write_log(stop_log_.update(status));
    reported_permit_ = found;
    reported_missing_ = absent;
    reported_ = permit;
    reported_ns_ = now_ns;
  }

  void diagnose(DiagnosticReport& report) override {
    if (Permit permit; seen(permit)) report_permit(report, permit, programs());
  }

 private:
  bool live(SensorFrame& sensors) {
    return process().sensors().newest(sensors) == Lookup::kFrame && process().is_current(sensors.head);
  }

  /// Reads the newest permit of this process. The permit of an earlier process does not count.
  bool seen(Permit& permit) {
    return process().output().newest(permit) == Lookup::kFrame && permit.head.run == process().cycle().published_run();
  }

  /// Returns the topics to which the controller subscribes. With a list that is refused the controller does not start.
  std::vector<std::string> command_topics() {
    if (kind_of(robot()) == MachineKind::kOnLegs) return {"body_pose", "foot_target", "joint_trajectory"};
    std::vector<std::string> topics;
    try {
      const std::string path = parameters_of(Role::kController).command_sources;
      if (path.empty()) return {"cmd_vel", "cmd_vel_stamped"};
      for (const CommandSource& source : read_command_sources(path).sources) topics.push_back(source.topic);
    } catch (const ParameterError&) {
    }
    return topics;
  }

  void note_latch_file(SafetyStatus& status) {
    const std::string& problem = process().latch_file_problem();
    if (problem.empty()) return;
    status.warnings.emplace_back("latch_file");
    status.warning_sentences.push_back(
        ascii("latch_file is not writable: a stop would be lost after a reboot: " + problem + " (set " +
              std::string(program_of(Role::kMonitor)) + ".latch_file to a file that this user may write)"));
  }

  void add(std::uint64_t OperatorInput::*counter) {
    const std::lock_guard lock(input_mutex_);
    ++(input_.*counter);
    process().cycle().inbox().store(input_);
  }

  void receive_e_stop(const std::string& publisher, bool stop) {
    const std::lock_guard lock(input_mutex_);
    levels_.receive(publisher, stop);
    input_.e_stop_level = levels_.stopped() ? 1 : 0;
    ++input_.e_stop_messages;
    if (stop) ++input_.e_stop_triggers;
    process().cycle().inbox().store(input_);
  }

  void hold_e_stop() {
    const std::lock_guard lock(input_mutex_);
    levels_.hold();
    input_.e_stop_level = 1;
    process().cycle().inbox().store(input_);
  }

  /// Ends the levels that end with a reset request, if the publishers are known. The request to the master may take
  /// long, so the inputs are not locked during it.
  void settle_e_stop() {
    {
      const std::lock_guard lock(input_mutex_);
      if (!levels_.stopped()) return;
    }
    const auto present = publishers_known_to_reach(e_stop_topic_);
    if (!present) return;
    const std::lock_guard lock(input_mutex_);
    levels_.settle(*present);
    input_.e_stop_level = levels_.stopped() ? 1 : 0;
  }

  std::vector<std::string> e_stop_publishers() {
    const std::lock_guard lock(input_mutex_);
    return levels_.publishers();
  }

  void receive_clearance(double clearance) {
    const std::lock_guard lock(input_mutex_);
    clearance_stream_.receive(clearance, monotonic_ns());
    set_clearance(clearance);
  }

  void set_clearance(double clearance) {
    input_.clearance = clearance;
    ++input_.clearances;
    process().cycle().inbox().store(input_);
  }

  void check_clearance(std::int64_t now_ns) {
    const std::lock_guard lock(input_mutex_);
    if (!clearance_stream_.falls_silent(now_ns)) return;
    set_clearance(0);
    ROS_WARN("no message on clearance: the robot stops. Restart its sender, or publish inf on clearance");
  }

  bool trigger(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
    add(&OperatorInput::e_stop_services);
    Permit permit;
    for (const std::int64_t end = monotonic_ns() + kTriggerWait; monotonic_ns() < end; sleep_ns(kResetLook)) {
      if (!seen(permit) || (permit.causes & kCauseEmergencyStopService) == 0) continue;
      return answer(response, true, "stopped; call e_stop_reset to drive again");
    }
    return answer(
        response, false,
        "the stop is not confirmed: the monitor's loop has not latched it yet; use the hardware e-stop" + waiting());
  }

  bool reset(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
    const std::unique_lock one_at_a_time(reset_mutex_, std::try_to_lock);
    // Waiting here would leave no thread to receive e_stop.
    if (!one_at_a_time) return answer(response, false, "another reset is in progress: call again");
    settle_e_stop();
    Permit permit;
    Permit before;
    if (seen(permit)) before = permit;
    add(&OperatorInput::resets);
    for (const std::int64_t end = monotonic_ns() + kResetWait; monotonic_ns() < end; sleep_ns(kResetLook)) {
      if (!seen(permit)) continue;
      if (permit.resets_handled == before.resets_handled) {
        before = permit;
        continue;
      }
      const Publishers publishers{.commands = publishers_of(command_topics_), .e_stop = e_stop_publishers()};
      return answer(response, permit.reset_refusal == 0, reset_text(before, permit, publishers, programs()));
    }
    return answer(response, false, "not handled within 1 s: the safety monitor receives no sensor data" + waiting());
  }

  /// Returns "; waiting for …" for each missing node.
  std::string waiting() const {
    std::string text;
    for (const std::string& name : missing()) text += "; waiting for " + name;
    return text;
  }

  std::vector<std::string> command_topics_;
  std::string e_stop_topic_;
  ros::Publisher status_;
  InputTopic<BoundedBool> e_stop_{"e_stop", 10};
  InputTopic<BoundedEmpty> heartbeat_{"heartbeat", 1};
  InputTopic<BoundedFloat64> clearance_{"clearance", 1};
  ros::ServiceServer trigger_;
  ros::ServiceServer reset_;
  std::mutex input_mutex_;
  std::mutex reset_mutex_;
  EStopLevels levels_;
  ClearanceStream clearance_stream_;
  OperatorInput input_;
  StopLog stop_log_{static_cast<double>(parameters().loop.period_ns()) * 1e-9,
                    kind_of(robot()) == MachineKind::kOnLegs ? parameters().leg_control.request_timeout
                                                             : parameters().controller.cmd_vel_timeout,
                    composed().kind()};
  WithdrawalTime withdrawal_;
  Permit reported_;
  bool reported_permit_ = false;
  std::vector<std::string> reported_missing_;
  std::int64_t reported_ns_ = 0;
};

}  // namespace

std::unique_ptr<Node> make_monitor(const Setup& setup) {
  return std::make_unique<MonitorNode>(setup);
}

}  // namespace robot_control
