#pragma once
/// A ProcessNode is a Node that runs a Process; it is the common part of the four nodes of the loop.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "configuration/rate_notes.h"
#include "loop/processes/process.h"
#include "robots/robot_kind.h"
#include "ros/messages/time_map.h"
#include "ros/nodes/node.h"
#include "ros/reports/timing_report.h"
#include "rt/clock.h"
#include "signals/robot_kinds.h"

namespace robot_control {

template <class Work>
class ProcessNode : public Node {
 public:
  /// `more` are the arguments of Work's constructor behind parameters, robot and bus.
  template <class... More>
  ProcessNode(const Setup& setup, Role role, More&&... more)
      : setup_(setup),
        role_(role),
        time_(setup.parameters.loop.clock),
        composed_(compose(setup.parameters, *setup.machine)),
        process_(setup.parameters, *composed_, setup.bus, std::forward<More>(more)...) {
    if (setup.parameters.loop.clock == ClockMode::kLockstep) return;  // no time passes within a cycle
    timing_ = std::make_unique<TimingReport>(setup.parameters.loop, setup.bus, role);
  }

  std::vector<std::string> rate_notes() const override {
    const bool controller = role_ == Role::kController;
    const std::string_view block = controller ? names_of_kind(composed_->kind()).controller : program_of(role_);
    std::vector<std::string> notes = robot_control::rate_notes(parameters(), block);
    for (std::string& note : composed_->rate_notes(role_)) notes.push_back(std::move(note));
    return notes;
  }

  void poll() override {
    process_.poll();
    if (timing_ != nullptr) timing_->poll(process_.realtime_thread(), monotonic_ns());
  }
  void diagnose_timing(DiagnosticReport& report) override {
    if (timing_ != nullptr) timing_->report(report, monotonic_ns());
  }
  bool finished() const override { return process_.finished(); }
  void stop() override { process_.stop(); }

  /// Returns the state of the last poll; any thread may call it.
  std::vector<std::string> missing() const override { return process_.last_missing(); }

  std::vector<std::string> realtime_messages() const override { return process_.realtime_messages(); }

 protected:
  const Parameters& parameters() const { return setup_.parameters; }
  const ReportParameters& report() const { return setup_.parameters.report; }
  const MachineModel& robot() const { return *setup_.machine; }
  const Robot& composed() const { return *composed_; }
  Programs programs() const noexcept { return programs_of(setup_.parameters, composed_->kind()); }
  Work& process() { return process_; }
  TimeMap& time() { return time_; }

 private:
  Setup setup_;
  Role role_;
  TimeMap time_;
  std::unique_ptr<Robot> composed_;
  Work process_;
  std::unique_ptr<TimingReport> timing_;  ///< null in lockstep
};

}  // namespace robot_control
