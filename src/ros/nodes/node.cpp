#include "ros/nodes/node.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/master.h>
#include <ros/ros.h>

#include <algorithm>
#include <atomic>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <utility>

#include "bus/bus_cleanup.h"
#include "ros/network/accepted_sockets.h"
#include "ros/network/loopback.h"
#include "ros/network/wire_guard.h"
#include "ros/nodes/launch_end.h"
#include "ros/reports/diagnostics.h"
#include "ros/reports/name_list.h"
#include "ros/startup/command_line.h"
#include "ros/startup/description.h"
#include "rt/clock.h"
#include "rt/crash_report.h"
#include "rt/futex.h"
#include "rt/process_limits.h"
#include "rt/realtime_thread.h"

namespace robot_control {
namespace {

constexpr std::int64_t kPollPeriod = 100'000'000;          // ns
constexpr std::int64_t kDiagnosticPeriod = 1'000'000'000;  // ns
constexpr std::int64_t kSilentWait = 2'000'000'000;        // ns; a node that waits longer reports for which nodes
constexpr unsigned kCallbackThreads = 2;  // one may wait in a service while the other one receives e_stop

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // required in a signal handler

void interrupt(int /*signal*/) {
  interrupted.store(true);
}

/// Replaces ROS's own handler, which would shut down the connections before the node has saved its data.
void catch_signals() {
  struct sigaction action {};
  action.sa_handler = interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/// A WaitingNote reports once, after kSilentWait, for which nodes this node waits, and once that all of them run.
class WaitingNote {
 public:
  void report(const std::vector<std::string>& missing, std::int64_t now_ns) {
    if (missing.empty()) {
      if (reported_) ROS_INFO("all required nodes are running");
      reported_ = false;
      since_ns_ = now_ns;
      return;
    }
    if (reported_ || now_ns - since_ns_ < kSilentWait) return;
    ROS_WARN("waiting for %s", joined(missing).c_str());
    reported_ = true;
  }

 private:
  bool reported_ = false;
  std::int64_t since_ns_ = monotonic_ns();
};

/// Waits for the master, without which no parameter can be read, and logs this once. Returns false when interrupted.
bool await_master(const std::string& name) {
  constexpr std::int64_t kRetry = 200'000'000;  // ns
  for (bool reported = false; !ros::master::check(); reported = true) {
    if (interrupted.load()) return false;
    if (!reported)
      std::fprintf(stderr, "%s: waiting for the ROS master at %s\n", name.c_str(), ros::master::getURI().c_str());
    sleep_ns(kRetry);
  }
  return true;
}

/// Reports closed connections, at most once in 10 s.
class ConnectionNote {
 public:
  void report(std::int64_t now_ns) {
    const std::uint64_t evicted = evicted_connections();
    const std::uint64_t refused = overlong_announcements();
    if ((evicted == evicted_ && refused == overlong_) || now_ns < next_ns_) return;
    next_ns_ = now_ns + kSilence;
    if (evicted != evicted_) {
      ROS_WARN(
          "too many open files: %llu connections to this node were closed; check which program opens so many: ss -tnp",
          static_cast<unsigned long long>(evicted - evicted_));
    }
    if (refused != overlong_) {
      ROS_WARN(
          "message too large (max: header %u bytes, message %u bytes): %llu connections were closed; check which "
          "program sends such messages: ss -tnp",
          kMaxHeader, max_message(), static_cast<unsigned long long>(refused - overlong_));
    }
    evicted_ = evicted;
    overlong_ = refused;
  }

 private:
  static constexpr std::int64_t kSilence = 10'000'000'000;  // ns

  std::uint64_t evicted_ = 0;
  std::uint64_t overlong_ = 0;
  std::int64_t next_ns_ = 0;
};

/// Waits for SIGINT: roslaunch ends its nodes one after the other and reports one that ends before its turn as dead.
void await_interrupt() {
  constexpr std::int64_t kLimit = 20'000'000'000;  // ns; roslaunch gives a node 15 s before SIGTERM
  constexpr std::int64_t kLook = 10'000'000;       // ns
  for (const std::int64_t end = monotonic_ns() + kLimit; !interrupted.load() && monotonic_ns() < end;) sleep_ns(kLook);
}

/// Waits until roslaunch starts no more nodes.
void await_launched() {
  constexpr std::int64_t kQuiet = 2'000'000'000;   // ns; it starts several nodes in a second
  constexpr std::int64_t kLimit = 20'000'000'000;  // ns
  constexpr std::int64_t kLook = 50'000'000;       // ns
  std::string nodes = launched_nodes();
  std::int64_t since_ns = monotonic_ns();
  for (const std::int64_t end = since_ns + kLimit; !interrupted.load() && monotonic_ns() < end; sleep_ns(kLook)) {
    if (std::string now = launched_nodes(); now != nodes) {
      nodes = std::move(now);
      since_ns = monotonic_ns();
    }
    if (monotonic_ns() - since_ns > kQuiet) return;
  }
}

constexpr const char* kStartRefused = "start_refused";  // parameter that why.py shows while no node runs

/// Prints the reason. A robot or a setup that is refused ends the launch, in which the other nodes refuse it, too.
void refuse(const NodeProgram& program, const std::exception& error) {
  const bool all = dynamic_cast<const SetupError*>(&error) != nullptr ||
                   dynamic_cast<const ParameterError*>(&error) != nullptr ||
                   dynamic_cast<const RobotError*>(&error) != nullptr;
  const bool ends = program.in_loop && (all || program.name == program_of(Role::kDriver)) && launched();
  if (ends && interrupted.load()) return;  // another node has said why, and the launch ends
  const bool first = !ends || first_to_refuse();
  if (first) std::fprintf(stderr, "%s: refused:\n%s\n", program.name.c_str(), error.what());
  if (first && ends) await_launched();  // a node that starts meanwhile deletes the parameter
  if (first && all && program.in_loop) ros::param::set(kStartRefused, std::string(error.what()));
  if (!ends) return;
  if (!first || end_launch()) await_interrupt();
}

class NodeLoop {
 public:
  NodeLoop(Node& node, const Setup& setup, ros::NodeHandle& handle)
      : node_(node),
        setup_(setup),
        diagnostics_(handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 2)) {}

  void run() {
    while (ros::ok() && !interrupted.load() && !node_.finished()) {
      const std::int64_t now_ns = monotonic_ns();
      if (now_ns >= next_poll_ns_) poll(now_ns);
      if (now_ns >= next_diagnostic_ns_) diagnose(now_ns);
      node_.publish();
      sleep_until(now_ns + node_.tick_ns());
    }
  }

 private:
  void poll(std::int64_t now_ns) {
    next_poll_ns_ = now_ns + kPollPeriod;
    node_.poll();
    waiting_.report(node_.missing(), now_ns);
    connections_.report(now_ns);
    log_refusals(node_.realtime_messages());
  }

  /// Logs all refusals in one line, because every node logs them.
  void log_refusals(const std::vector<std::string>& refusals) {
    if (refusals_reported_ || refusals.empty()) return;
    refusals_reported_ = true;
    ROS_WARN("%s: see docs/realtime.md", joined(refusals).c_str());
  }

  void diagnose(std::int64_t now_ns) {
    next_diagnostic_ns_ = now_ns + kDiagnosticPeriod;
    DiagnosticReport report(ros::this_node::getName().substr(1), setup_.machine ? setup_.machine->name : "");
    report_missing(report, node_.missing());
    node_.diagnose(report);
    node_.diagnose_timing(report);
    diagnostic_msgs::DiagnosticArray array;
    array.header.stamp = ros::Time::now();
    array.status.push_back(report.message());
    if (array.status[0].message.empty()) array.status[0].message = "running";
    diagnostics_.publish(array);
  }

  Node& node_;
  const Setup& setup_;
  ros::Publisher diagnostics_;
  WaitingNote waiting_;
  ConnectionNote connections_;
  bool refusals_reported_ = false;
  std::int64_t next_poll_ns_ = 0;
  std::int64_t next_diagnostic_ns_ = 0;
};

}  // namespace

int run_node(int argc, char** argv, const NodeProgram& program) {
  const std::string& name = program.name;
  const std::string file = std::filesystem::path(argv[0]).filename().string();
  if (const auto answer = answer_command_line(file, program.purpose, {argv + 1, argv + argc})) {
    std::fputs(answer->text.c_str(), answer->refused ? stderr : stdout);
    return answer->refused ? 1 : 0;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // else a log file stays empty until the end
  std::setlocale(LC_CTYPE, "C.UTF-8");       // else rosconsole prints "N·m" as "N??m"; numbers keep the decimal point
  install_crash_report(name, !program.in_loop      ? "the loop continues"
                             : name == "telemetry" ? "the log with it"
                                                   : "the motors brake without it");
  ignore_file_size_signal();
  if (const std::string problem = descriptor_problem(); !problem.empty()) {
    std::fprintf(stderr, "%s: refused:\n%s\n", name.c_str(), problem.c_str());
    return 1;
  }
  bind_as_ros_is_configured();
  try {
    ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
    catch_signals();
    if (!await_master(name)) return 0;
    const Setup setup = read_setup(name, program.in_loop);
    const LoopParameters& loop = setup.parameters.loop;
    const bool realtime = program.in_loop && loop.clock == ClockMode::kWall;
    prepare_process(realtime ? loop.realtime : RealtimePolicy::kOff);
    const std::unique_ptr<Node> node = program.make(setup);

    ros::NodeHandle handle;
    catch_signals();  // a second time, because ROS has installed its own handler
    if (const std::string problem = unguarded(); !problem.empty()) ROS_WARN("%s", problem.c_str());
    if (const std::size_t ended = remove_ended_buses(setup.bus).size(); ended != 0) {
      ROS_INFO("removed the shared memory of %zu runs that have ended", ended);
    }
    for (const std::string& text : setup.unexpected_overrides) ROS_INFO("%s", text.c_str());
    for (const std::string& text : setup.parameters.warnings) ROS_WARN("%s", text.c_str());
    if (!setup.unread_description.empty() && !launched()) ROS_WARN("%s", setup.unread_description.c_str());
    for (const std::string& text : node->rate_notes()) ROS_WARN("%s", text.c_str());
    node->connect(handle);
    if (program.in_loop) ros::param::del(kStartRefused);
    ros::AsyncSpinner callbacks(kCallbackThreads);
    if (!node->calls_callbacks()) callbacks.start();
    NodeLoop(*node, setup, handle).run();
    node->stop();  // before the callbacks stop, so that a service that waits for cycles ends
    callbacks.stop();
    if (node->finished() && !interrupted.load() && end_launch()) await_interrupt();
    return 0;
  } catch (const std::exception& error) {
    if (ros::isInitialized()) forget_argument();
    refuse(program, error);
    return 1;
  }
}

std::int64_t publish_tick_ns(const Parameters& parameters, std::int64_t stamp_ns,
                             std::initializer_list<const Pacer*> topics) {
  constexpr std::int64_t kMinTick = 250'000;     // ns
  constexpr std::int64_t kMaxTick = 10'000'000;  // the period of the fastest topic by default
  if (parameters.loop.clock == ClockMode::kLockstep) return kMinTick;
  const std::int64_t cycle_ns = parameters.loop.period_ns();
  std::int64_t tick = kMaxTick;
  for (const Pacer* topic : topics)
    tick = std::min(tick, topic->period_ns() < 4 * cycle_ns ? cycle_ns / 4 : topic->until_due_ns(stamp_ns));
  return std::clamp(tick, kMinTick, kMaxTick);
}

}  // namespace robot_control
