#pragma once
/// A robot of four processes drives at full speed and then loses one of them.

#include <csignal>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "loop/processes/process.h"
#include "rt/clock.h"
#include "rt/futex.h"
#include "signals/names.h"
#include "support/processes/drive_log.h"
#include "support/processes/node_processes.h"
#include "support/processes/stall_witness.h"

namespace robot_control {

/// Causes that a machine may latch by itself after it stood still for loss_cycles.
inline constexpr std::uint64_t kStallCauses = kCauseDriverLost | kCauseControllerLost | kCauseEstimatorLost |
                                              kCauseMonitorLate | kCauseCommandStale | kCauseGateRefuses;

/// A stop, from a signal to standstill.
struct MeasuredStop {
  std::uint64_t cycles = 0;   ///< from the newest cycle before the signal to the first of all that braked
  std::uint64_t blurred = 0;  ///< cycles that passed until the signal had its effect: the uncertainty of `cycles`
  bool before = false;        ///< it braked already: this machine stood still, and nothing is measured
  double distance = 0;        ///< m, true, from then to standstill
  std::uint64_t reasons = 0;  ///< the gate's, in the first cycle that braked

  /// False if this machine delayed the test, or the process that gets the signal: the trial must be repeated.
  bool measured() const noexcept { return !before && blurred <= 2; }
};

class DrivingRobot {
 public:
  static constexpr double kFullSpeed = 1.0;       ///< m/s: max_linear_speed
  static constexpr double kTimeout = 30.0;        ///< s; an event that takes longer has not happened
  static constexpr std::size_t kRestCycles = 20;  ///< twice as many as the monitor requires

  /// `robot`: composed with these parameters; left out: a robot on wheels.
  template <class... Composed>
  explicit DrivingRobot(const Parameters& parameters, const Composed&... robot)
      : witness_(parameters.loop.core),
        nodes_(parameters, robot...),
        log_(nodes_.bus()),
        sensors_(nodes_.bus(), ChannelNames::kSensors),
        permits_(nodes_.bus(), ChannelNames::kPermit),
        truth_(nodes_.bus(), ChannelNames::kTruth) {
    nodes_.start_loop();
  }

  /// The users' parameters, but for accelerations that a test has time for: what motors of 2 · 3.5 N·m on wheels of
  /// 0.1 m give 12 kg is 5.8 m/s²; brakes of 2 · 2.2 N·m, 3.7 m/s². What is assumed of brakes on ice would make every
  /// reset wait for 2 s.
  static Parameters quick(const std::string& params) {
    Parameters parameters = read_parameters(params);
    parameters.controller.max_linear_acceleration = 5.0;
    parameters.safety.stop_deceleration = 2.5;
    return parameters;
  }

  NodeProcesses& nodes() noexcept { return nodes_; }
  DriveLog& log() noexcept { return log_; }

  /// Newest on the channel; cycle 0 of run 0 where there is none.
  Permit permit() const {
    Permit permit;
    return permits_.reader.newest(permit) == Lookup::kFrame ? permit : Permit{};
  }
  SensorFrame sensors() const {
    SensorFrame sensors;
    for (int tries = 0; tries < 100; ++tries) {
      if (sensors_.reader.newest(sensors) == Lookup::kFrame) return sensors;
    }
    return {};
  }
  std::uint64_t cycle() const { return sensors().head.cycle; }

  /// The newest frame; for tests that cannot wait for the trace.
  TruthFrame truth() const {
    TruthFrame truth;
    return truth_.reader.newest(truth) == Lookup::kFrame ? truth : TruthFrame{};
  }
  double speed() const { return truth().twist_base.linear[0]; }  ///< m/s

  /// From now on an operator requests this, 20 times a second.
  void ask_for(double speed) { ask_for({.twist = {.linear = {speed, 0, 0}}}); }
  void ask_for(const Request& request) {
    asked_ = request;
    next_send_ns_ = 0;
  }
  void ask_for_nothing() { asked_.reset(); }

  /// Sends, maps and reads what is due.
  void poll() {
    const std::int64_t now_ns = monotonic_ns();
    if (asked_ && now_ns >= next_send_ns_) {
      next_send_ns_ = now_ns + kSendNs;
      command_.content = *asked_;
      ++command_.count;
      nodes_.controls().command.store(command_);
    }
    if (!watching_) return;
    if (mapping_ && now_ns >= next_poll_ns_) {
      next_poll_ns_ = now_ns + kPollNs;
      sensors_.poll();
      permits_.poll();
      truth_.poll();
      log_.poll();
    }
    log_.read_rows();
  }

  /// Objects are no longer opened again: a damaged one would be an error.
  void keep_mappings() noexcept { mapping_ = false; }

  /// Memory that is about to be cut off must not be touched: nothing of all this is known until `reopen_channels`.
  void close_channels() {
    watching_ = false;
    log_ = DriveLog(nodes_.bus());
    sensors_.reader = FrameReader<SensorFrame>();
    permits_.reader = FrameReader<Permit>();
    truth_.reader = FrameReader<TruthFrame>();
  }

  /// Opens the valid objects of those names.
  void reopen_channels() {
    close_channels();
    sensors_.channel = ForeignChannel<LatestFrames<SensorFrame>>(nodes_.bus(), ChannelNames::kSensors);
    permits_.channel = ForeignChannel<LatestFrames<Permit>>(nodes_.bus(), ChannelNames::kPermit);
    truth_.channel = ForeignChannel<LatestFrames<TruthFrame>>(nodes_.bus(), ChannelNames::kTruth);
    watching_ = true;
    mapping_ = true;
  }

  /// Waits until the condition holds. False: it did not in time.
  template <class Condition>
  bool await(Condition condition, double timeout_s = kTimeout) {
    const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(timeout_s * 1e9);
    for (poll(); !condition(); poll()) {
      if (monotonic_ns() > end_ns) return false;
      sleep_ns(kLookNs);
    }
    return true;
  }

  /// Waits for so many cycles.
  bool await_cycles(std::uint64_t count) {
    const std::uint64_t end = log_.empty() ? count : log_.last().cycle + count;
    return await([&] { return !log_.empty() && log_.last().cycle >= end; });
  }

  /// Kills the remains of the node, and starts it.
  void restart(LoopNode node) {
    nodes_.start(node);
    if (node == LoopNode::kController) command_ = {};
    if (node == LoopNode::kMonitor) operator_input_ = {};
  }

  /// Ends and starts all of them. A latched stop stays latched.
  void restart_all() {
    for (const LoopNode node : kLoop) nodes_.end(node);
    for (const LoopNode node : kLoop) restart(node);
  }

  /// Requests a reset once; returns the refusals, 0 if accepted. Throws std::runtime_error without an answer.
  std::uint64_t ask_reset() {
    ++operator_input_.resets;
    nodes_.controls().operator_input.store(operator_input_);
    if (!await([&] { return permit().resets_handled == operator_input_.resets; })) {
      throw std::runtime_error("no node answers a reset");
    }
    return permit().reset_refusal;
  }

  /// The operator requests zero, and resets until one is accepted.
  void release() {
    ask_for(0);
    if (!await([&] { return log_.rested(kRestCycles); })) throw std::runtime_error("does not stand: " + situation());
    if (!await([&] { return ask_reset() == 0; })) throw std::runtime_error("is not released: " + situation());
  }

  /// Undoes what `signal` did to the node.
  void bring_back(LoopNode node, int signal) {
    if (signal == SIGSTOP) {
      nodes_.process(node).send(SIGCONT);
    } else {
      restart(node);
    }
  }

  /// Waits for the end of INIT, and releases a stop. Throws std::runtime_error if that fails.
  void make_ready() {
    if (unreleased()) ask_for(0);
    if (!await([&] { return !unreleased(); })) throw std::runtime_error("not ready: " + situation());
    if (permit().state == SupervisorState::kStopped) release();
    released_ns_ = monotonic_ns();
  }

  /// True if only causes of a stall stopped it, after a stall that the witness measured while the robot was to drive.
  /// Command and permit may have survived the first kPermitLife of loss_cycles periods.
  bool stalled() const {
    const std::uint64_t causes = permit().causes;
    const auto& parameters = nodes_.parameters();
    const double lost = static_cast<double>(parameters.safety.loss_cycles - kPermitLife) * parameters.loop.period();
    return causes != 0 && (causes & ~kStallCauses) == 0 &&
           static_cast<double>(witness_.longest_gap_ns(released_ns_)) * 1e-9 >= lost;
  }

  /// Starts from any state: a stop may be noticed late, so one on the way is released. A second one is released after a
  /// stall alone; otherwise it throws std::runtime_error.
  void drive_at_full_speed() {
    const auto fast = [&] { return !log_.empty() && log_.last().speed > 0.97 * kFullSpeed; };
    const auto latched = [&] { return permit().state == SupervisorState::kStopped; };
    for (int tries = 0; tries < kTries; ++tries) {
      make_ready();
      ask_for(kFullSpeed);
      if (await([&] { return fast() || latched() || unreleased(); }) && fast()) return;
      if (tries > 0 && latched() && !stalled())
        throw std::runtime_error("stopped without a stall of this machine: " + situation());
    }
    throw std::runtime_error("does not reach full speed: " + situation());
  }

  /// Sends the signal at full speed and watches until the robot stands. Throws std::runtime_error if it does not.
  MeasuredStop lose(LoopNode node, int signal) {
    poll();
    log_.forget();
    const std::uint64_t before = cycle();
    nodes_.process(node).stop_with(signal);
    MeasuredStop stop{.blurred = cycle() - before};
    if (!await([&] { return log_.rested(kRestCycles); })) throw std::runtime_error("does not stop: " + situation());
    const std::uint64_t braked = *log_.braking_since();
    stop.before = braked <= before;
    stop.cycles = stop.before ? 0 : braked - before;
    stop.distance = log_.way_since(before);
    for (const DrivenCycle& driven : log_.cycles()) {
      if (driven.cycle == braked) stop.reasons = driven.reasons;
    }
    return stop;
  }

  /// The present state as text, for messages.
  std::string situation() {
    const Permit last = permit();
    std::string text = "monitor: state " + std::string(name_of(last.state)) + ", causes " +
                       names_of(kStopCauseNames, last.causes) + ", missing " +
                       names_of(kMissingNodeNames, last.missing) + "; reset refused for " +
                       names_of(kResetRefusalNames, last.reset_refusal);
    if (!log_.empty()) {
      text += "; gate: " + names_of(kGateReasonNames, log_.last().reasons) + " in cycle " +
              std::to_string(log_.last().cycle) + ", speed " + std::to_string(log_.last().speed) + " m/s";
    }
    for (const LoopNode node : kLoop) {
      if (const std::string said = nodes_.said(node); !said.empty()) text += "\n" + said;
    }
    return text;
  }

 private:
  bool unreleased() const { return permit().state == SupervisorState::kInit || log_.empty(); }

  static constexpr int kTries = 5;
  static constexpr std::int64_t kSendNs = 50'000'000;
  static constexpr std::int64_t kPollNs = 20'000'000;
  static constexpr std::int64_t kLookNs = 500'000;

  StallWitness witness_;
  NodeProcesses nodes_;
  DriveLog log_;
  Input<SensorFrame> sensors_;
  Input<Permit> permits_;
  Input<TruthFrame> truth_;
  VelocityCommand command_;
  OperatorInput operator_input_;
  std::optional<Request> asked_;
  std::int64_t next_send_ns_ = 0;
  std::int64_t next_poll_ns_ = 0;
  std::int64_t released_ns_ = 0;  // time at which it was last free to drive
  bool watching_ = true;
  bool mapping_ = true;
};

}  // namespace robot_control
