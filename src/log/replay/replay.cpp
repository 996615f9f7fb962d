#include "log/replay/replay.h"

#include <algorithm>
#include <initializer_list>
#include <span>
#include <utility>

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

/// Every difference between two rows of one node.
template <class Trace>
std::vector<FieldDifference> differences_of(const Trace& logged, const Trace& computed) {
  JoinedRow was, is;
  was.put(logged);
  is.put(computed);
  return differences(was, is);
}

TraceRow owned(const JoinedRow& row) {
  TraceRow copy;
  copy.run = row.run;
  copy.cycle = row.cycle;
  copy.repeats = row.repeats;
  const auto keep = [&copy](const auto* from, auto& to, TracePart part) {
    if (from == nullptr) return;
    to = *from;
    copy.parts = static_cast<std::uint8_t>(copy.parts | part);
  };
  keep(row.driver, copy.driver, kPartDriver);
  keep(row.laws.estimator, copy.estimator, kPartEstimator);
  keep(row.laws.controller, copy.controller, kPartController);
  keep(row.laws.monitor, copy.monitor, kPartMonitor);
  return copy;
}

/// Keeps the published frame for the other laws: `computed`, or the one that a fault made of it.
template <class Frame>
void publish(const LawRow& law, const Frame& logged, const Frame* computed, FrameHistory<Frame>& published) {
  if (logged.head.kind != FrameKind::kFrame) return;
  if (intact(logged)) {
    published.add(logged.head.checksum, logged);
  } else if (computed != nullptr && logged.head.checksum == law.output) {
    published.add(law.output, *computed);
  }
}

}  // namespace

Replay::Replay(const Robot& robot, double period)
    : row_check_(robot.machine().joints.size(), report_),
      gate_{Gate(joint_limits(robot.machine()), robot.gate(), period), Continuity(LawName::kGate, report_)},
      estimator_{robot.make_estimator(), Continuity(LawName::kEstimator, report_)},
      controller_{robot.make_controller(), Continuity(LawName::kController, report_)},
      monitor_{robot.make_monitor(), Continuity(LawName::kMonitor, report_)} {}

void Replay::vary(const Robot& robot, std::function<void(const VariedRow&)> watch) {
  variant_ = std::make_unique<Variant>(robot);
  watch_ = std::move(watch);
}

void Replay::add(const LawSnapshot& snapshot) {
  if (!snapshots_.add(snapshot)) ++report_.damaged_snapshots;
}

void Replay::add(const JoinedRow& row) {
  TraceRow copy = owned(row);
  run_laws(copy);
}

void Replay::add(TraceRow row, std::string_view message, std::int64_t time_ns) {
  run_laws(row);
  row_check_.check(row, message, time_ns);
}

/// Replaces the outputs of the laws in the row by the computed ones.
void Replay::run_laws(TraceRow& row) {
  if ((row.parts & kPartDriver) != 0) run(row, row.driver);
  if ((row.parts & kPartEstimator) != 0) run(row, row.estimator);
  if ((row.parts & kPartController) != 0) run(row, row.controller);
  if ((row.parts & kPartMonitor) != 0) run(row, row.monitor);
}

void Replay::differ(const TraceRow& row, LawName law, const std::vector<FieldDifference>& fields) {
  ++report_.laws[static_cast<std::size_t>(law)].different;
  for (const FieldDifference& field : fields) {
    report_.add({law, row.run, row.cycle, field.field, field.logged, field.replayed});
  }
}

template <class Replica>
StateBefore Replay::before(Replica& replica, const LawRow& row) {
  return replica.continuity.before(
      row, snapshots_, [&](const LawSnapshot& snapshot) { return restore_state(snapshot, law_of(replica.law)); });
}

/// False: the state of the law, or a frame that it used, is not known; the row is not compared.
template <class Replica, class Trace>
bool Replay::known(const TraceRow& row, Replica& replica, Trace& trace, StateBefore state, const std::string& missing) {
  if (state != StateBefore::kUnknown && !missing.empty()) replica.continuity.lose(missing);
  if (replica.continuity.known()) return true;
  publish(trace.calls.law, replica.frame_of(trace), decltype(&replica.output){}, replica.published);
  replica.continuity.pass_over(row.run, row.cycle);
  return false;
}

template <class Replica, class Trace>
void Replay::compare(const TraceRow& row, Replica& replica, Trace& trace, FaultKind fault) {
  replica.continuity.compare();
  LawRow& law = trace.calls.law;
  auto& logged = replica.frame_of(trace);
  auto& computed = replica.output;
  computed.head = {.run = logged.head.run, .cycle = logged.head.cycle, .stamp_ns = logged.head.stamp_ns};
  seal(computed);
  if (computed.head.checksum != law.output) {
    std::vector<FieldDifference> fields;
    if (logged.head.checksum == law.output && intact(logged)) {
      Trace expected = trace;
      replica.frame_of(expected) = computed;
      replica.frame_of(expected).head = logged.head;
      fields = differences_of(trace, expected);
    }
    if (fields.empty()) fields = {{"digest", std::to_string(law.output), std::to_string(computed.head.checksum)}};
    differ(row, replica.continuity.law(), fields);
  }
  publish(law, logged, &computed, replica.published);
  law.output = computed.head.checksum;
  expect(computed, fault, logged);
}

/// Returns the sentence on the missing frame; empty: none is missing.
std::string Replay::gate_input(const DriverTrace& driver, GateInput& input) const {
  static const Permit kNoPermit;
  static const CommandFrame kNoCommand;
  const GateCalls& calls = driver.calls;
  const Permit* permit = monitor_.published.find(calls.permit.checksum);
  const CommandFrame* command = controller_.published.find(calls.command.checksum);
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

void Replay::run(const TraceRow& row, DriverTrace& driver) {
  LawRow& law = driver.calls.law;
  const bool has_sensors = intact(driver.sensors);
  if (has_sensors) gate_.published.add(driver.sensors.head.checksum, driver.sensors);
  seal(driver.sensors);
  law.sensors = driver.sensors.head.checksum;
  const StateBefore state = before(gate_, law);
  if (state == StateBefore::kUnknown) return gate_.continuity.pass_over(row.run, row.cycle);
  GateInput input;
  const std::string missing = has_sensors ? gate_input(driver, input) : unknown({{"sensor frame", false, row.cycle}});
  if (!missing.empty()) {
    gate_.continuity.lose(missing);
    return gate_.continuity.pass_over(row.run, row.cycle);
  }
  if (state == StateBefore::kContinued && law.new_run != 0) gate_.law.enter_run();
  const std::span<const JointCommand> commands = gate_.law.step(input);
  gate_.continuity.compare();
  const std::uint64_t output = digest_of(commands, gate_.law.report());
  if (law.output != output) {
    DriverTrace expected = driver;
    expected.gate = gate_.law.report();
    std::vector<FieldDifference> fields = differences_of(driver, expected);
    if (fields.empty()) fields = {{"commands", "others", "what the state and the inputs give"}};
    differ(row, LawName::kGate, fields);
  }
  law.output = output;
  driver.gate = gate_.law.report();
  driver.calls.permit = used(input.permit_found, *input.permit);
  driver.calls.command = used(input.command_found, *input.command);
}

void Replay::run(const TraceRow& row, EstimatorTrace& trace) {
  EstimatorCalls& calls = trace.calls;
  const StateBefore state = before(estimator_, calls.law);
  SensorFrame sensors;
  const bool has_sensors = sensors_of(gate_.published, trace.state.head, calls.law.sensors, sensors);
  const std::string missing = unknown({{"sensor frame", has_sensors, row.cycle}});
  if (!known(row, estimator_, trace, state, missing)) return;
  if (state == StateBefore::kContinued && calls.law.new_run != 0) estimator_.law->enter_run();
  if (calls.pose_set != 0) estimator_.law->set_pose(calls.pose);
  const StateFrame* varied = variant_ == nullptr ? nullptr : variant_->step(calls, sensors);
  estimator_.law->step(sensors, estimator_.output);
  estimator_.output.first_cycle = calls.first_cycle;
  compare(row, estimator_, trace, fault_of(sensors.injected, FaultComponent::kEstimator));
  if (varied == nullptr) return;
  watch_({.run = row.run, .cycle = row.cycle, .state = &estimator_.output, .varied_state = varied});
}

void Replay::run(const TraceRow& row, ControllerTrace& trace) {
  ControllerCalls& calls = trace.calls;
  const StateBefore state = before(controller_, calls.law);
  SensorFrame sensors;
  const bool permitted = calls.permit.found == Lookup::kFrame;
  const ControlInput input{.sensors = &sensors,
                           .state = estimator_.published.find(calls.state),
                           .permit = permitted ? monitor_.published.find(calls.permit.checksum) : nullptr,
                           .request = calls.request};
  const bool has_sensors = sensors_of(gate_.published, trace.command.head, calls.law.sensors, sensors);
  const std::string missing = unknown({{"sensor frame", has_sensors, row.cycle},
                                       {"state", input.state != nullptr, row.cycle},
                                       {"permit", !permitted || input.permit != nullptr, calls.permit.cycle}});
  if (!known(row, controller_, trace, state, missing)) return;
  if (state == StateBefore::kContinued && calls.law.new_run != 0) {
    controller_.law->enter_run(calls.inbox, calls.with_zero != 0);
  }
  if (calls.tuned != 0) controller_.law->tune(trace.tuning);
  const CommandFrame* varied = variant_ == nullptr ? nullptr : variant_->step(calls, input, *controller_.law);
  controller_.law->step(input, controller_.output);
  compare(row, controller_, trace, fault_of(sensors.injected, FaultComponent::kController));
  trace.tuning = controller_.law->tuning();
  calls.permit = permitted ? used(Lookup::kFrame, *input.permit) : UsedFrame{};
  if (varied == nullptr) return;
  watch_({.run = row.run, .cycle = row.cycle, .command = &controller_.output, .varied_command = varied});
}

void Replay::run(const TraceRow& row, MonitorTrace& trace) {
  MonitorCalls& calls = trace.calls;
  const StateBefore state = before(monitor_, calls.law);
  SensorFrame sensors;
  const bool framed = calls.law.sensors != 0;
  const bool commanded = calls.command.found == Lookup::kFrame, estimated = calls.state.found == Lookup::kFrame;
  const bool has_sensors = !framed || sensors_of(gate_.published, trace.permit.head, calls.law.sensors, sensors);
  const MonitorInput input{.sensors = framed ? &sensors : nullptr,
                           .silence = calls.silence,
                           .command = commanded ? controller_.published.find(calls.command.checksum) : nullptr,
                           .state = estimated ? estimator_.published.find(calls.state.checksum) : nullptr,
                           .corrupt = calls.corrupt,
                           .operator_input = calls.operator_input};
  const std::string missing = unknown({{"sensor frame", has_sensors, row.cycle},
                                       {"command", !commanded || input.command != nullptr, calls.command.cycle},
                                       {"state", !estimated || input.state != nullptr, calls.state.cycle}});
  if (!known(row, monitor_, trace, state, missing)) return;
  const Permit* varied = variant_ == nullptr ? nullptr : variant_->step(calls, input);
  monitor_.law->step(input, monitor_.output);
  compare(row, monitor_, trace, fault_of(sensors.injected, FaultComponent::kMonitor));
  if (framed) calls.silence = SensorSilence::kNone;
  calls.command = commanded ? used(Lookup::kFrame, *input.command) : UsedFrame{.found = calls.command.found};
  calls.state = estimated ? used(Lookup::kFrame, *input.state) : UsedFrame{.found = calls.state.found};
  if (varied == nullptr) return;
  watch_({.run = row.run, .cycle = row.cycle, .permit = &monitor_.output, .varied_permit = varied});
}

void RowCheck::check(TraceRow& row, std::string_view message, std::int64_t time_ns) {
  place(row);
  const JoinedRow computed = row.joined(0);
  const std::vector<FieldDifference> fields =
      differences(message, {.row = computed, .lost = row.lost, .joints = joints_, .time_ns = time_ns});
  ++report_.rows;
  if (!fields.empty()) ++report_.different_rows;
  for (const FieldDifference& field : fields) {
    report_.add({{}, row.run, row.cycle, field.field, field.logged, field.replayed});
  }
}

/// The rows of a run are in the order of their cycles. A row that repeats a cycle follows the row of that cycle.
void RowCheck::place(TraceRow& row) noexcept {
  const bool goes_on = run_ >= 0 && row.run_id == run_id_;
  const std::uint64_t cycle = goes_on && row.repeats ? cycle_ : row.cycle;
  row.run = goes_on ? run_ : std::max(row.run, run_ + 1);
  row.repeats = goes_on && row.cycle <= cycle_;
  run_ = row.run;
  run_id_ = row.run_id;
  cycle_ = cycle;
}

}  // namespace robot_control
