#include "runtime/cycles/monitor_cycle.h"

#include <cmath>
#include <utility>

namespace robot_control {

MonitorCycle::MonitorCycle(const SafetyParameters& parameters, const RobotModel& robot, double period,
                           const Channels& channels, CommandScript script, Now now)
    : monitor_(parameters, robot, period),
      clock_(now),
      channels_(channels),
      script_(std::move(script)),
      robot_hash_(robot.hash),
      loss_ns_(std::llround(static_cast<double>(parameters.loss_cycles) * period * 1e9)),
      snapshots_(LawName::kMonitor) {
  restore_last_permit();
}

void MonitorCycle::restore_last_permit() noexcept {
  Permit last;
  const Lookup found = FrameReader<Permit>(channels_.permit.memory()).last_whole(last);
  if (found == Lookup::kFrame) monitor_.restore(last);
  if (found == Lookup::kCorrupt) monitor_.restore(kCauseLatchUnreadable, kCauseLatchUnreadable);
}

void MonitorCycle::enter_run() noexcept {
  script_.rewind();
  if (const auto last = published_before(channels_.permit, sensors_.head.run)) script_.advance(*last);
  receive_messages();
  calls_.law.new_run = 1;
  note(MonitorCall::kEnterRun, operator_input_);
  monitor_.enter_run(operator_input_);
}

/// What is called between two rows; `output` follows where it is a step.
void MonitorCycle::note(MonitorCall call, const OperatorInput& operator_input, std::uint64_t argument) noexcept {
  if (calls_.event_count == kMonitorEvents) {
    ++calls_.events_lost;
    return;
  }
  calls_.events[calls_.event_count++] = {.call = call, .argument = argument, .operator_input = operator_input};
}

/// The last event was a step.
void MonitorCycle::note_output(std::uint64_t output) noexcept {
  if (calls_.events_lost == 0) calls_.events[calls_.event_count - 1].output = output;
}

void MonitorCycle::receive_messages() noexcept {
  OperatorInput arrived = received_;
  inbox_.load(arrived);
  operator_input_.e_stop_level = arrived.e_stop_level;
  operator_input_.e_stop_messages += arrived.e_stop_messages - received_.e_stop_messages;
  operator_input_.e_stop_triggers += arrived.e_stop_triggers - received_.e_stop_triggers;
  operator_input_.e_stop_services += arrived.e_stop_services - received_.e_stop_services;
  operator_input_.resets += arrived.resets - received_.resets;
  operator_input_.heartbeats += arrived.heartbeats - received_.heartbeats;
  operator_input_.clearances += arrived.clearances - received_.clearances;
  operator_input_.clearance = arrived.clearance;
  received_ = arrived;
}

void MonitorCycle::receive(std::uint64_t cycle) noexcept {
  receive_messages();
  const ScriptEvents events = script_.advance(cycle);
  operator_input_.e_stop_services += events.e_stops;
  operator_input_.resets += events.resets;
}

bool MonitorCycle::step() noexcept {
  const std::int64_t woke_ns = clock_.now();
  const bool first_look = !std::exchange(looked_, true);
  const Lookup found = channels_.sensors->newest(arrived_);
  if (found == Lookup::kCorrupt) note_corrupt_sensors();
  if (found != Lookup::kFrame) return wake_without_sensors(woke_ns);
  if (!current(*channels_.sensors, arrived_.head, robot_hash_)) return wake_without_sensors(woke_ns);
  const Arrival arrival = clock_.judge(arrived_.head);
  current_ns_ = woke_ns;
  if (arrival == Arrival::kOld) {
    note_pause();
    return false;
  }
  sensors_ = arrived_;
  if (arrival == Arrival::kNewRun) enter_run();
  if (first_look) {
    note(MonitorCall::kBegin, {}, sensors_.head.cycle);
    monitor_.begin(sensors_.head.cycle);
  }
  clock_.accept(sensors_.head);
  silent_ = false;

  const std::uint64_t run = sensors_.head.run;
  const std::uint64_t cycle = sensors_.head.cycle;
  receive(cycle);
  input_ = {.sensors = &sensors_, .corrupt = corrupt_sensors_ > 0, .operator_input = operator_input_};
  corrupt_sensors_ = 0;
  if (cycle > 0) {
    const Lookup command_found = channels_.command->at(run, cycle - 1, command_);
    const Lookup state_found = channels_.state->at(run, cycle - 1, state_);
    input_.command = command_found == Lookup::kFrame ? &command_ : nullptr;
    calls_.command = used(command_found, command_);
    input_.state_seen = state_found == Lookup::kFrame;
    input_.state_first_cycle = input_.state_seen ? state_.first_cycle : 0;
    input_.corrupt = input_.corrupt || command_found == Lookup::kCorrupt || state_found == Lookup::kCorrupt;
  }
  snapshots_.look(monitor_, calls_.law, sensors_.head);
  monitor_.step(input_, trace_.permit);
  published_run_.store(run, std::memory_order_release);
  publish();
  trace_.timing = clock_.timing(woke_ns, sensors_);
  close_row();
  return true;
}

void MonitorCycle::note_corrupt_sensors() noexcept {
  if (++corrupt_sensors_ != FrameConditions::kPersistence || input_.sensors == nullptr) return;
  note(MonitorCall::kSensorsCorrupt);
  monitor_.sensors_corrupt();
  publish_again();
}

void MonitorCycle::close_row() noexcept {
  calls_.state_seen = input_.state_seen ? 1 : 0;
  calls_.state_first_cycle = input_.state_first_cycle;
  calls_.corrupt = input_.corrupt ? 1 : 0;
  calls_.operator_input = noted_ = input_.operator_input;
  robot_control::close_row(calls_, sensors_.head.checksum, trace_.permit.head.checksum, trace_.calls);
}

bool MonitorCycle::wake_without_sensors(std::int64_t woke_ns) noexcept {
  const bool wall_clock = woke_ns != 0;
  if (wall_clock && current_ns_ != 0 && woke_ns - current_ns_ >= loss_ns_) silence();
  return false;
}

/// A driver that pauses or ends publishes its last frame again. Nothing in it is judged twice, but no other one will
/// come, and from a paused driver it comes ten times a second: an operator shall not wait for an answer meanwhile.
void MonitorCycle::note_pause() noexcept {
  if (arrived_.head.cycle != clock_.cycle()) return;
  if (arrived_.driver_state == DriverState::kEnded && sensors_.driver_state != DriverState::kEnded) {
    sensors_.driver_state = arrived_.driver_state;
    if (input_.sensors != nullptr) {
      note(MonitorCall::kDriverEnded);
      monitor_.driver_ended();
      publish_again();
    }
  }
  if (arrived_.driver_state != DriverState::kPaused) return;
  sensors_.driver_state = arrived_.driver_state;
  idle();
}

void MonitorCycle::silence() noexcept {
  const bool expected = sensors_.driver_state == DriverState::kPaused || sensors_.driver_state == DriverState::kEnded;
  if (!silent_ && input_.sensors != nullptr && !expected) {
    silent_ = true;
    note(MonitorCall::kDriverLost);
    monitor_.driver_lost();
    publish_again();
  }
  idle();
}

void MonitorCycle::idle_without_driver() noexcept {
  const OperatorInput before = operator_input_;
  receive_messages();
  const bool reset = operator_input_.resets != before.resets;
  const bool stopped = note_emergency_stop();
  const bool restored = published_run() == 0 && monitor_.causes() != 0;
  if (!reset && !stopped && !restored) return;
  if (reset) refuse_reset(kRefusalSilent);
  note(MonitorCall::kStepWithoutSensors, operator_input_);
  monitor_.step_without_sensors(operator_input_, trace_.permit);
  trace_.permit.head = {.run = kRunBeforeDriver};
  published_run_.store(kRunBeforeDriver, std::memory_order_release);
  channels_.permit.publish(trace_.permit);
  note_output(trace_.permit.head.checksum);
}

/// Ten times a second while time stands still: what repeats itself is not noted.
bool MonitorCycle::note_emergency_stop() noexcept {
  const bool news = operator_input_.e_stop_messages != noted_.e_stop_messages ||
                    operator_input_.e_stop_services != noted_.e_stop_services;
  const bool stopped = monitor_.note_emergency_stop(operator_input_);
  if (news || stopped) note(MonitorCall::kEmergencyStop, operator_input_);
  noted_ = operator_input_;
  return stopped;
}

void MonitorCycle::refuse_reset(ResetRefusal why) noexcept {
  note(MonitorCall::kRefuseReset, operator_input_, why);
  monitor_.refuse_reset(operator_input_, why);
}

void MonitorCycle::idle() noexcept {
  if (input_.sensors == nullptr) {
    idle_without_driver();
    return;
  }
  const std::uint64_t resets = operator_input_.resets;
  receive_messages();
  const bool reset = operator_input_.resets != resets;
  const bool stopped = note_emergency_stop();
  if (!reset && !stopped) return;
  input_.operator_input = operator_input_;
  const bool paused = sensors_.driver_state == DriverState::kPaused;
  if (reset) refuse_reset(paused ? kRefusalPaused : kRefusalSilent);
  publish_again();
}

void MonitorCycle::publish_again() noexcept {
  note(MonitorCall::kStepAgain, input_.operator_input, static_cast<std::uint64_t>(sensors_.driver_state));
  monitor_.step(input_, trace_.permit);
  publish();
  note_output(trace_.permit.head.checksum);
}

void MonitorCycle::publish() noexcept {
  trace_.permit.head = {.run = clock_.run(), .cycle = clock_.cycle(), .stamp_ns = sensors_.head.stamp_ns};
  channels_.permit.publish(trace_.permit);
}

}  // namespace robot_control
