#include "runtime/cycles/monitor_cycle.h"

#include <cmath>
#include <utility>

namespace robot_control {

MonitorCycle::MonitorCycle(const SafetyParameters& parameters, const RobotModel& robot, double period,
                           const Channels& channels, CommandScript script, Now now,
                           OutputDecoratorPtr<Permit> decorator)
    : monitor_(parameters, robot, period),
      clock_(now),
      channels_(channels),
      output_(channels.permit, std::move(decorator)),
      script_(std::move(script)),
      robot_hash_(robot.hash),
      loss_ns_(std::llround(static_cast<double>(parameters.loss_cycles) * period * 1e9)) {
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
  monitor_.reset(operator_input_);
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
  if (found == Lookup::kMissing || found == Lookup::kCorrupt) return wake_without_sensors(woke_ns);
  if (!current(*channels_.sensors, arrived_.head, robot_hash_)) return wake_without_sensors(woke_ns);
  const Arrival arrival = clock_.judge(arrived_.head);
  current_ns_ = woke_ns;
  if (arrival == Arrival::kOld) {
    if (found == Lookup::kFrame) note_pause();
    return false;
  }
  sensors_ = arrived_;
  if (arrival == Arrival::kNewRun) enter_run();
  if (first_look) monitor_.begin(sensors_.head.cycle);
  clock_.accept(sensors_.head);
  silent_ = false;
  if (found == Lookup::kToken) {
    publish_token(channels_.permit, sensors_.head);
    return false;
  }

  const std::uint64_t run = sensors_.head.run;
  const std::uint64_t cycle = sensors_.head.cycle;
  receive(cycle);
  input_ = {.sensors = &sensors_, .corrupt = corrupt_sensors_ > 0, .operator_input = operator_input_};
  corrupt_sensors_ = 0;
  if (cycle > 0) {
    const Lookup command_found = channels_.command->at(run, cycle - 1, command_);
    const Lookup state_found = channels_.state->at(run, cycle - 1, state_);
    input_.command = command_found == Lookup::kFrame ? &command_ : nullptr;
    input_.state_seen = state_found == Lookup::kFrame;
    input_.state_first_cycle = input_.state_seen ? state_.first_cycle : 0;
    input_.corrupt = input_.corrupt || command_found == Lookup::kCorrupt || state_found == Lookup::kCorrupt;
  }
  monitor_.step(input_, trace_.permit);
  published_run_.store(run, std::memory_order_release);
  if (!output_.publish(head(), sensors_, trace_.permit)) return false;
  trace_.timing = clock_.timing(woke_ns, sensors_);
  return true;
}

void MonitorCycle::note_corrupt_sensors() noexcept {
  if (++corrupt_sensors_ != FrameConditions::kPersistence || input_.sensors == nullptr) return;
  monitor_.sensors_corrupt();
  publish_again();
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
    monitor_.driver_lost();
    publish_again();
  }
  idle();
}

void MonitorCycle::idle_without_driver() noexcept {
  const OperatorInput before = operator_input_;
  receive_messages();
  const bool reset = operator_input_.resets != before.resets;
  const bool stopped = monitor_.note_emergency_stop(operator_input_);
  const bool restored = published_run() == 0 && monitor_.causes() != 0;
  if (!reset && !stopped && !restored) return;
  if (reset) monitor_.refuse_reset(operator_input_, kRefusalSilent);
  monitor_.step_without_sensors(operator_input_, trace_.permit);
  trace_.permit.head = {.run = kRunBeforeDriver};
  published_run_.store(kRunBeforeDriver, std::memory_order_release);
  channels_.permit.publish(trace_.permit);
}

void MonitorCycle::idle() noexcept {
  if (input_.sensors == nullptr) {
    idle_without_driver();
    return;
  }
  const std::uint64_t resets = operator_input_.resets;
  receive_messages();
  const bool reset = operator_input_.resets != resets;
  const bool stopped = monitor_.note_emergency_stop(operator_input_);
  if (!reset && !stopped) return;
  input_.operator_input = operator_input_;
  const bool paused = sensors_.driver_state == DriverState::kPaused;
  if (reset) monitor_.refuse_reset(operator_input_, paused ? kRefusalPaused : kRefusalSilent);
  publish_again();
}

void MonitorCycle::publish_again() noexcept {
  monitor_.step(input_, trace_.permit);
  output_.publish_again(head(), sensors_, trace_.permit);
}

FrameHead MonitorCycle::head() const noexcept {
  return {.run = clock_.run(), .cycle = clock_.cycle(), .stamp_ns = sensors_.head.stamp_ns};
}

}  // namespace robot_control
