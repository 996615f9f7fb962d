#include "ros/nodes/telemetry_node.h"

#include <ros/master.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>

#include <atomic>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "loop/log_header.h"
#include "loop/processes/telemetry_process.h"
#include "robots/robot_kind.h"
#include "ros/messages/service_answer.h"
#include "ros/reports/diagnostics.h"
#include "ros/startup/setup.h"
#include "rt/realtime_thread.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

constexpr std::int64_t kDrainPeriod = 2'000'000;  // ns; the black box misses at most this much after a crash
constexpr double kLookSeconds = 1;
constexpr std::int64_t kLockstepDrainPeriod = 1'000'000;  // ns; in lockstep a full ring delays the loop

/// Returns the parameters of all nodes for the header of a log, with their private ones. A node whose parameters are
/// refused does not start; for it the header has those that this node has read.
Parameters with_blocks_of_other_nodes(Parameters parameters) {
  const auto take = [](Role role, auto put) {
    try {
      put(parameters_of(role));
    } catch (const ParameterError&) {
      ROS_WARN("the parameters of %s are refused; the header of the log holds others",
               std::string(program_of(role)).c_str());
    }
  };
  take(Role::kDriver, [&](const Parameters& read) { parameters.plant = read.plant; });
  take(Role::kEstimator, [&](const Parameters& read) { parameters.estimator = read.estimator; });
  take(Role::kController, [&](const Parameters& read) {
    parameters.controller = read.controller;
    parameters.leg_control = read.leg_control;
    parameters.command_sources = read.command_sources;
  });
  take(Role::kMonitor, [&](const Parameters& read) { parameters.safety = read.safety; });
  return parameters;
}

class TelemetryNode final : public Node {
 public:
  explicit TelemetryNode(const Setup& setup)
      : setup_(setup),
        lockstep_(setup.parameters.loop.clock == ClockMode::kLockstep),
        precedes_(!lockstep_ && setup.parameters.loop.realtime != RealtimePolicy::kOff),
        quota_(setup.parameters.telemetry.quota),
        composed_(compose(setup.parameters, *setup.machine)),
        process_(with_blocks_of_other_nodes(setup.parameters), *composed_, setup.bus) {}

  void connect(ros::NodeHandle& /*handle*/) override {
    if (setup_.parameters.telemetry.record != RecordMode::kRequest) log_path();
    if (const std::string& path = process_.black_box_path(); !path.empty()) {
      ROS_INFO("black box: %s", absolute(path).c_str());
    }
    ros::NodeHandle own("~");
    record_ = own.advertiseService("record", &TelemetryNode::record, this);
    look_ = own.createWallTimer(ros::WallDuration(kLookSeconds),
                                [this](const ros::WallTimerEvent&) { read_parameters_again(); });
  }
  void poll() override { process_.poll(); }
  void publish() override {
    // The priority is raised from the first call on: rows that other programs delay are missing in the black box after
    // a crash.
    if (std::exchange(precedes_, false)) precede_ordinary_threads();
    process_.drain();
    parameter_changes_.store(process_.parameter_changes());
    if (const std::lock_guard lock(header_mutex_); header_) {
      process_.set_header(*header_);
      header_.reset();
    }
    for (const std::string& path : process_.take_removed()) {
      ROS_WARN("removed %s, the oldest log: telemetry.quota = %g GB", path.c_str(), quota_);
    }
    for (const std::string& note : process_.take_notes()) ROS_WARN("black box: %s", note.c_str());
    process_.request_recording(requested_.load());
    if (process_.recording()) log_path();
    const std::string problem = process_.problem();
    if (problem == reported_) return;
    if (!problem.empty()) ROS_ERROR("%s. The loop continues; its rows are counted, but lost", problem.c_str());
    if (problem.empty()) ROS_INFO("the log is written again");
    reported_ = problem;
  }
  std::int64_t tick_ns() const override { return lockstep_ ? kLockstepDrainPeriod : kDrainPeriod; }
  bool finished() const override { return false; }
  std::vector<std::string> missing() const override { return process_.missing(); }
  std::vector<std::string> realtime_messages() const override { return {}; }

  void stop() override {
    process_.finish();
    for (const std::string& note : process_.take_notes()) ROS_WARN("black box: %s", note.c_str());
    const TelemetryCounts counts = process_.counts();
    const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    if (path_logged_) {
      ROS_INFO("%llu rows in %s, %llu dropped, %llu overwritten, %llu not written to the disk", number(counts.bag_rows),
               process_.bag_path().c_str(), number(counts.dropped), number(counts.overwritten),
               number(counts.bag_unwritten));
    }
  }

  void diagnose(DiagnosticReport& report) override {
    const TelemetryCounts counts = process_.counts();
    const auto sum = [](const auto& nodes) { return std::accumulate(nodes.begin(), nodes.end(), std::uint64_t{0}); };
    if (counts.dropped + counts.overwritten + counts.bag_unwritten != 0) report.warn("rows were lost");
    if (!process_.problem().empty()) report.error(process_.problem());
    if (!process_.bag_path().empty()) report.value("bag", absolute(process_.bag_path()));  // identify.py reads it
    if (!process_.black_box_path().empty()) {
      report.value("black_box", absolute(process_.black_box_path()));
      report.value("incidents", counts.incidents);
    }
    report.value("recording", std::uint64_t{process_.recording()});
    report.value("rows", counts.join.emitted);
    report.value("bag_rows", counts.bag_rows);
    report.value("absent", sum(counts.join.absent));
    report.value("late", sum(counts.join.late));
    report.value("dropped", counts.dropped);
    report.value("overwritten", counts.overwritten);
    report.value("bag_unwritten", counts.bag_unwritten);
  }

 private:
  /// Logs once where the log is written.
  void log_path() {
    if (process_.bag_path().empty() || std::exchange(path_logged_, true)) return;
    ROS_INFO("log: %s; telemetry.quota = %g GB", absolute(process_.bag_path()).c_str(), quota_);
  }

  static std::string absolute(const std::string& path) {
    return std::filesystem::absolute(path).lexically_normal().string();
  }

  /// Reads the parameters twice for each change, because the controller uses new values before the server has them. It
  /// runs in a callback thread, because it may wait for the master.
  void read_parameters_again() {
    const std::uint64_t changes = parameter_changes_.load();
    if (changes == changes_followed_ || !ros::master::check()) return;
    LogHeader header = log_header(with_blocks_of_other_nodes(setup_.parameters), *composed_);
    if (std::exchange(changes_read_, changes) == changes) changes_followed_ = changes;
    const std::lock_guard lock(header_mutex_);
    header_ = std::move(header);
  }

  bool record(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
    const bool on = request.data != 0;
    const bool recordable = !process_.bag_path().empty();
    requested_.store(on);
    return answer(response, recordable,
                  !recordable ? "telemetry.record is off: there is no run.bag"
                  : on        ? "run.bag contains every cycle from now on"
                              : "run.bag contains what telemetry.record selects");
  }

  const Setup& setup_;
  bool lockstep_;
  bool precedes_;  ///< this thread is still to be given a higher priority
  double quota_;   ///< GB
  bool path_logged_ = false;
  std::string reported_;  ///< problem that was reported last
  std::atomic<bool> requested_{false};
  std::unique_ptr<Robot> composed_;
  TelemetryProcess process_;
  std::atomic<std::uint64_t> parameter_changes_{0};
  std::uint64_t changes_read_ = 0;      ///< number of changes after which the parameters were read once
  std::uint64_t changes_followed_ = 0;  ///< number of changes after which they were read twice
  std::mutex header_mutex_;
  std::optional<LogHeader> header_;  ///< read by a callback thread, written to the log by the ordinary one
  ros::ServiceServer record_;
  ros::WallTimer look_;
};

}  // namespace

std::unique_ptr<Node> make_telemetry(const Setup& setup) {
  return std::make_unique<TelemetryNode>(setup);
}

}  // namespace robot_control
