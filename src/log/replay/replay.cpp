#include "log/replay/replay.h"

#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "log/replay/field_differences.h"
#include "log/replay/owned_row.h"
#include "log/replay/replicas.h"
#include "log/replay/row_check.h"
#include "loop/gate_setup.h"
#include "signals/gate_digest.h"

namespace robot_control {
namespace {

/// Names the first frame that a law used and that is neither in the log nor computed again; empty: none.
struct Needed {
  const char* name;
  bool known;
  std::uint64_t cycle;
};
std::string unknown(std::initializer_list<Needed> frames) {
  for (const Needed& frame : frames) {
    if (!frame.known)
      return std::string("the ") + frame.name + " of cycle " + std::to_string(frame.cycle) +
             ", which it used, is not known";
  }
  return {};
}

template <class LawType>
LawType& law_of(std::unique_ptr<LawType>& law) {
  return *law;
}
Gate& law_of(Gate& law) {
  return law;
}

/// The rows of one node, as the other nodes had none.
JoinedRow alone(const DriverTrace& trace) {
  return {.driver = &trace};
}
JoinedRow alone(const EstimatorTrace& trace) {
  return {.laws = {.estimator = &trace}};
}
JoinedRow alone(const ControllerTrace& trace) {
  return {.laws = {.controller = &trace}};
}
JoinedRow alone(const MonitorTrace& trace) {
  return {.laws = {.monitor = &trace}};
}

StateFrame& frame_of(EstimatorTrace& trace) {
  return trace.state;
}
CommandFrame& frame_of(ControllerTrace& trace) {
  return trace.command;
}
Permit& frame_of(MonitorTrace& trace) {
  return trace.permit;
}

/// The head of the frame that a law computes in the cycle of `head`.
FrameHead own_head(const FrameHead& head) {
  return {.run = head.run, .cycle = head.cycle, .stamp_ns = head.stamp_ns};
}

}  // namespace

struct Replay::Parts {
  Parts(const Robot& robot, double period)
      : row_check(robot.machine().joints.size(), report),
        gate{Gate(joint_limits(robot.machine()), robot.gate(), period), Continuity(LawName::kGate, report)},
        estimator{robot.make_estimator(), Continuity(LawName::kEstimator, report), {}},
        controller{robot.make_controller(), Continuity(LawName::kController, report), {}},
        monitor{robot.make_monitor(), Continuity(LawName::kMonitor, report), {}} {}

  void add(OwnedRow row);
  void run(const OwnedRow& row, DriverTrace& driver);
  void run(const OwnedRow& row, EstimatorTrace& trace);
  void run(const OwnedRow& row, ControllerTrace& trace);
  void run(const OwnedRow& row, MonitorTrace& trace);
  std::string gate_input(const DriverTrace& driver, GateInput& input) const;

  template <class Replica>
  StateBefore before(Replica& replica, const LawRow& row) {
    return replica.continuity.before(
        row, snapshots, [&](const LawSnapshot& snapshot) { return restore_state(snapshot, law_of(replica.law)); });
  }

  template <class Trace, class Replica, class Frame>
  void compare(const OwnedRow& row, Replica& replica, Trace& trace, FaultKind fault, FrameHistory<Frame>& published);
  template <class Frame>
  void publish(const LawRow& law, const Frame& logged, const Frame* computed, FrameHistory<Frame>& published);
  template <class Replica>
  void pass_over(const OwnedRow& row, Replica& replica) {
    replica.continuity.pass_over(row.run(), row.cycle());
  }
  void differ(const OwnedRow& row, LawName law, const std::vector<FieldDifference>& fields);

  ReplayReport report;
  RowCheck row_check;
  SnapshotStore snapshots;
  PublishedFrames frames;
  GateReplica gate;
  LawReplica<EstimatorLaw, StateFrame> estimator;
  LawReplica<ControllerLaw, CommandFrame> controller;
  LawReplica<MonitorLaw, Permit> monitor;
  std::unique_ptr<Variant> variant;
  std::function<void(const VariedRow&)> watch;
};

Replay::Replay(const Robot& robot, double period) : parts_(std::make_unique<Parts>(robot, period)) {}
Replay::~Replay() = default;

void Replay::vary(const Robot& robot, std::function<void(const VariedRow&)> watch) {
  parts_->variant = std::make_unique<Variant>(robot);
  parts_->watch = std::move(watch);
}

void Replay::add(const LawSnapshot& snapshot) {
  if (!parts_->snapshots.add(snapshot)) ++parts_->report.damaged_snapshots;
}

void Replay::add(const JoinedRow& row) {
  parts_->add(OwnedRow(row));
}

void Replay::add(const TraceRow& row, std::string_view message, std::int64_t time_ns) {
  parts_->add(OwnedRow(row, message, time_ns));
}

const ReplayReport& Replay::report() const noexcept {
  return parts_->report;
}

/// Replaces the outputs of the laws in the row by the computed ones.
void Replay::Parts::add(OwnedRow row) {
  if (row.driver() != nullptr) run(row, *row.driver());
  if (row.estimator() != nullptr) run(row, *row.estimator());
  if (row.controller() != nullptr) run(row, *row.controller());
  if (row.monitor() != nullptr) run(row, *row.monitor());
  if (!row.message().empty()) row_check.check(row);
}

void Replay::Parts::differ(const OwnedRow& row, LawName law, const std::vector<FieldDifference>& fields) {
  ++report.laws[static_cast<std::size_t>(law)].different;
  for (const FieldDifference& field : fields) {
    report.add({law, row.run(), row.cycle(), field.field, field.logged, field.replayed});
  }
}

/// Keeps the published frame for the other laws: `computed`, or the one that a fault made of it.
template <class Frame>
void Replay::Parts::publish(const LawRow& law, const Frame& logged, const Frame* computed,
                            FrameHistory<Frame>& published) {
  if (logged.head.kind != FrameKind::kFrame) return;
  if (intact(logged)) {
    published.add(logged.head.checksum, logged);
  } else if (computed != nullptr && logged.head.checksum == law.output) {
    published.add(law.output, *computed);
  }
}

template <class Trace, class Replica, class Frame>
void Replay::Parts::compare(const OwnedRow& row, Replica& replica, Trace& trace, FaultKind fault,
                            FrameHistory<Frame>& published) {
  replica.continuity.compare();
  LawRow& law = trace.calls.law;
  Frame& logged = frame_of(trace);
  Frame& computed = replica.output;
  computed.head = own_head(logged.head);
  seal(computed);
  if (computed.head.checksum != law.output) {
    std::vector<FieldDifference> fields;
    if (logged.head.checksum == law.output && intact(logged)) {
      Trace expected = trace;
      frame_of(expected) = computed;
      frame_of(expected).head = logged.head;
      fields = differences(alone(trace), alone(expected));
    }
    if (fields.empty()) {
      fields = {{"digest", std::to_string(law.output), std::to_string(computed.head.checksum)}};
    }
    differ(row, replica.continuity.law(), fields);
  }
  publish(law, logged, &computed, published);
  law.output = computed.head.checksum;
  expect(computed, fault, logged);
}

/// Returns the sentence on the missing frame; empty: none is missing.
std::string Replay::Parts::gate_input(const DriverTrace& driver, GateInput& input) const {
  static const Permit kNoPermit;
  static const CommandFrame kNoCommand;
  const GateCalls& calls = driver.calls;
  const Permit* permit = frames.permit.find(calls.permit.checksum);
  const CommandFrame* command = frames.command.find(calls.command.checksum);
  if (calls.permit.found != Lookup::kFrame) permit = &kNoPermit;
  if (calls.command.found != Lookup::kFrame) command = &kNoCommand;
  input = {.run = driver.sensors.head.run,
           .cycle = driver.sensors.head.cycle,
           .permit_found = calls.permit.found,
           .permit = permit,
           .command_found = calls.command.found,
           .command = command,
           .sensors = &driver.sensors};
  return unknown(
      {{"permit", permit != nullptr, calls.permit.cycle}, {"command", command != nullptr, calls.command.cycle}});
}

void Replay::Parts::run(const OwnedRow& row, DriverTrace& driver) {
  LawRow& law = driver.calls.law;
  const bool has_sensors = intact(driver.sensors);
  if (has_sensors) frames.sensors.add(driver.sensors.head.checksum, driver.sensors);
  seal(driver.sensors);
  law.sensors = driver.sensors.head.checksum;
  const StateBefore state = before(gate, law);
  if (state == StateBefore::kUnknown) return pass_over(row, gate);
  GateInput input;
  const std::string missing = has_sensors ? gate_input(driver, input) : unknown({{"sensor frame", false, row.cycle()}});
  if (!missing.empty()) {
    gate.continuity.lose(missing);
    return pass_over(row, gate);
  }
  if (state == StateBefore::kContinued && law.new_run != 0) gate.law.enter_run();
  const std::span<const JointCommand> commands = gate.law.step(input);
  gate.continuity.compare();
  const std::uint64_t output = digest_of(commands, gate.law.report());
  if (law.output != output) {
    DriverTrace expected = driver;
    expected.gate = gate.law.report();
    std::vector<FieldDifference> fields = differences(alone(driver), alone(expected));
    if (fields.empty()) fields = {{"commands", "others", "what the state and the inputs give"}};
    differ(row, LawName::kGate, fields);
  }
  law.output = output;
  driver.gate = gate.law.report();
  driver.calls.permit = used(input.permit_found, *input.permit);
  driver.calls.command = used(input.command_found, *input.command);
}

void Replay::Parts::run(const OwnedRow& row, EstimatorTrace& trace) {
  EstimatorCalls& calls = trace.calls;
  const StateBefore state = before(estimator, calls.law);
  SensorFrame sensors;
  const bool has_sensors = sensors_of(frames.sensors, trace.state.head, calls.law.sensors, sensors);
  const std::string missing = unknown({{"sensor frame", has_sensors, row.cycle()}});
  if (state != StateBefore::kUnknown && !missing.empty()) estimator.continuity.lose(missing);
  if (!estimator.continuity.known()) {
    publish<StateFrame>(calls.law, trace.state, nullptr, frames.state);
    return pass_over(row, estimator);
  }
  if (state == StateBefore::kContinued && calls.law.new_run != 0) estimator.law->enter_run();
  if (calls.pose_set != 0) estimator.law->set_pose(calls.pose);
  const StateFrame* varied = variant == nullptr ? nullptr : variant->step(calls, sensors);
  estimator.law->step(sensors, estimator.output);
  estimator.output.first_cycle = calls.first_cycle;
  compare(row, estimator, trace, fault_of(sensors.injected, FaultComponent::kEstimator), frames.state);
  if (varied == nullptr) return;
  watch({.run = row.run(), .cycle = row.cycle(), .state = &estimator.output, .varied_state = varied});
}

void Replay::Parts::run(const OwnedRow& row, ControllerTrace& trace) {
  ControllerCalls& calls = trace.calls;
  const StateBefore state = before(controller, calls.law);
  SensorFrame sensors;
  const bool permitted = calls.permit.found == Lookup::kFrame;
  const ControlInput input{.sensors = &sensors,
                           .state = frames.state.find(calls.state),
                           .permit = permitted ? frames.permit.find(calls.permit.checksum) : nullptr,
                           .request = calls.request};
  const bool has_sensors = sensors_of(frames.sensors, trace.command.head, calls.law.sensors, sensors);
  const std::string missing = unknown({{"sensor frame", has_sensors, row.cycle()},
                                       {"state", input.state != nullptr, row.cycle()},
                                       {"permit", !permitted || input.permit != nullptr, calls.permit.cycle}});
  if (state != StateBefore::kUnknown && !missing.empty()) controller.continuity.lose(missing);
  if (!controller.continuity.known()) {
    publish<CommandFrame>(calls.law, trace.command, nullptr, frames.command);
    return pass_over(row, controller);
  }
  if (state == StateBefore::kContinued && calls.law.new_run != 0) {
    controller.law->enter_run(calls.inbox, calls.with_zero != 0);
  }
  if (calls.tuned != 0) controller.law->tune(trace.tuning);
  const CommandFrame* varied = variant == nullptr ? nullptr : variant->step(calls, input, *controller.law);
  controller.law->step(input, controller.output);
  compare(row, controller, trace, fault_of(sensors.injected, FaultComponent::kController), frames.command);
  trace.tuning = controller.law->tuning();
  calls.permit = permitted ? used(Lookup::kFrame, *input.permit) : UsedFrame{};
  if (varied == nullptr) return;
  watch({.run = row.run(), .cycle = row.cycle(), .command = &controller.output, .varied_command = varied});
}

void Replay::Parts::run(const OwnedRow& row, MonitorTrace& trace) {
  MonitorCalls& calls = trace.calls;
  const StateBefore state = before(monitor, calls.law);
  SensorFrame sensors;
  const bool framed = calls.law.sensors != 0;
  const bool commanded = calls.command.found == Lookup::kFrame, estimated = calls.state.found == Lookup::kFrame;
  const bool has_sensors = !framed || sensors_of(frames.sensors, trace.permit.head, calls.law.sensors, sensors);
  const MonitorInput input{.sensors = framed ? &sensors : nullptr,
                           .silence = calls.silence,
                           .command = commanded ? frames.command.find(calls.command.checksum) : nullptr,
                           .state = estimated ? frames.state.find(calls.state.checksum) : nullptr,
                           .corrupt = calls.corrupt,
                           .operator_input = calls.operator_input};
  const std::string missing = unknown({{"sensor frame", has_sensors, row.cycle()},
                                       {"command", !commanded || input.command != nullptr, calls.command.cycle},
                                       {"state", !estimated || input.state != nullptr, calls.state.cycle}});
  if (state != StateBefore::kUnknown && !missing.empty()) monitor.continuity.lose(missing);
  if (!monitor.continuity.known()) {
    publish<Permit>(calls.law, trace.permit, nullptr, frames.permit);
    return pass_over(row, monitor);
  }
  const Permit* varied = variant == nullptr ? nullptr : variant->step(calls, input);
  monitor.law->step(input, monitor.output);
  compare(row, monitor, trace, fault_of(sensors.injected, FaultComponent::kMonitor), frames.permit);
  if (framed) calls.silence = SensorSilence::kNone;
  calls.command = commanded ? used(Lookup::kFrame, *input.command) : UsedFrame{.found = calls.command.found};
  calls.state = estimated ? used(Lookup::kFrame, *input.state) : UsedFrame{.found = calls.state.found};
  if (varied == nullptr) return;
  watch({.run = row.run(), .cycle = row.cycle(), .permit = &monitor.output, .varied_permit = varied});
}

}  // namespace robot_control
