#include "loop/cycles/monitor_cycle.h"

#include <algorithm>
#include <utility>

#include "safety/conditions/common/frame_conditions.h"

namespace robot_control {

MonitorCycle::MonitorCycle(std::unique_ptr<MonitorLaw> monitor, std::uint64_t robot_hash, std::int64_t loss_ns,
                           const Channels& channels, CommandScript script, Now now, InheritedLatch latch)
    : monitor_(std::move(monitor)),
      clock_(now),
      channels_(channels),
      script_(std::move(script)),
      robot_hash_(robot_hash),
      loss_ns_(loss_ns),
      snapshots_(LawName::kMonitor),
      rows_(channels.permit.kept()) {
  inherit(latch);
}

MonitorCycle::MonitorCycle(const MonitorCycle& other, const Channels& channels) : MonitorCycle(other) {
  channels_ = channels;
}

void MonitorCycle::inherit(InheritedLatch latch) noexcept {
  Permit last;
  const Lookup found = channels_.permit.reader().last_whole(last);
  if (found == Lookup::kFrame) latch.permit = &last;
  if (found == Lookup::kCorrupt) {
    latch.causes |= kCauseLatchUnreadable;
    latch.first_cause = kCauseLatchUnreadable;
  }
  monitor_->step({.inherited = &latch}, rows_.last().permit);
}

void MonitorCycle::receive_messages() noexcept {
  const std::uint64_t version = inbox_.version();
  OperatorInput arrived;
  if (version == inbox_seen_ || !inbox_.load(arrived)) return;
  inbox_seen_ = version;
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

void MonitorCycle::advance_script() noexcept {
  if (calls_.law.new_run != 0) {
    script_.rewind();
    if (const auto last = published_before(channels_.permit, head_.run)) script_.advance(*last);
  }
  const ScriptEvents events = script_.advance(head_.cycle);
  operator_input_.e_stop_services += events.e_stops;
  operator_input_.resets += events.resets;
}

bool MonitorCycle::step() noexcept {
  const std::int64_t woke_ns = clock_.now();
  const auto [found, newest] = channels_.sensors->find_newest(buffer_);
  const SensorFrame& arrived = *newest;
  if (found == Lookup::kCorrupt) ++corrupt_sensors_;
  if (found != Lookup::kFrame || !current(*channels_.sensors, arrived.head, robot_hash_)) {
    const bool timed_out = woke_ns != 0 && current_ns_ != 0 && woke_ns - current_ns_ >= loss_ns_;
    return (timed_out || corrupt_sensors_ == FrameConditions::kPersistence) && step_without_frame(timed_out);
  }
  const Arrival arrival = clock_.compare(arrived.head);
  current_ns_ = woke_ns;
  if (arrival == Arrival::kOld) return republished(arrived) && step_without_frame(false);
  head_ = arrived.head;
  due_ns_ = due_ns(arrived);
  driver_state_ = arrived.driver_state;
  clock_.accept(head_);
  calls_.law.new_run = arrival == Arrival::kNewRun ? 1 : 0;
  receive_messages();
  advance_script();
  read_inputs(arrived);
  step_law(woke_ns);
  return true;
}

void MonitorCycle::read_inputs(const SensorFrame& sensors) noexcept {
  input_ = {.sensors = &sensors, .corrupt = corrupt_sensors_ > 0 ? 1U : 0U, .operator_input = operator_input_};
  corrupt_sensors_ = 0;
  const std::uint64_t run = head_.run;
  const std::uint64_t cycle = head_.cycle;
  calls_.command = calls_.state = {};
  if (cycle == 0) return;
  const auto [command_found, command] = channels_.command->find_at(run, cycle - 1, command_);
  const auto [state_found, state] = channels_.state->find_at(run, cycle - 1, state_);
  input_.command = command_found == Lookup::kFrame ? command : nullptr;
  calls_.command = used(command_found, *command);
  input_.state = state_found == Lookup::kFrame ? state : nullptr;
  calls_.state = used(state_found, *state);
  if (command_found == Lookup::kCorrupt || state_found == Lookup::kCorrupt) input_.corrupt = 1;
}

/// A driver that pauses or ends publishes its last frame again, a paused one ten times a second. No other frame will
/// come, so an operator's request is answered then.
bool MonitorCycle::republished(const SensorFrame& arrived) noexcept {
  const bool ends = arrived.driver_state == DriverState::kPaused || arrived.driver_state == DriverState::kEnded;
  if (!ends || arrived.head.cycle != clock_.cycle()) return false;
  driver_state_ = arrived.driver_state;
  return true;
}

SensorSilence MonitorCycle::silence(bool timed_out) const noexcept {
  if (clock_.run() == 0) return SensorSilence::kNone;
  if (driver_state_ == DriverState::kPaused) return SensorSilence::kPaused;
  if (driver_state_ == DriverState::kEnded) return SensorSilence::kEnded;
  return timed_out ? SensorSilence::kTimedOut : SensorSilence::kNone;
}

/// `input` holds a fact that the last step did not. A pause alone is none.
bool MonitorCycle::happened(const MonitorInput& input) const noexcept {
  const OperatorInput& now = input.operator_input;
  const OperatorInput& before = input_.operator_input;
  const bool requested = now.resets != before.resets || now.e_stop_services != before.e_stop_services ||
                         now.e_stop_messages != before.e_stop_messages || now.e_stop_level != before.e_stop_level;
  const bool restored = published_run() == 0 && permit().causes != 0;
  const bool corrupt = clock_.run() != 0 && input.corrupt == FrameConditions::kPersistence;
  const bool silent = input.silence == SensorSilence::kTimedOut || input.silence == SensorSilence::kEnded;
  return requested || restored || (corrupt && input_.corrupt != input.corrupt) ||
         (silent && input_.silence != input.silence);
}

bool MonitorCycle::step_without_frame(bool timed_out) noexcept {
  receive_messages();
  const MonitorInput input{.silence = silence(timed_out),
                           .corrupt = std::min(corrupt_sensors_, FrameConditions::kPersistence),
                           .operator_input = operator_input_};
  if (!happened(input)) return false;
  input_ = input;
  calls_.command = calls_.state = {};
  if (clock_.run() != 0) {
    step_law(clock_.now());
    return true;
  }
  monitor_->step(input_, rows_.last().permit);
  publish(kRunBeforeDriver, rows_.last().permit);
  return false;
}

void MonitorCycle::step_law(std::int64_t woke_ns) noexcept {
  snapshots_.copy_if_due(*monitor_, calls_.law, head_, channels_.permit.seals());
  MonitorTrace& row = rows_.begin(clock_.cycle());
  monitor_->step(input_, row.permit);
  publish(clock_.run(), row.permit);
  row.timing = clock_.timing(woke_ns, due_ns_);
  calls_.silence = input_.silence;
  calls_.corrupt = input_.corrupt;
  calls_.operator_input = input_.operator_input;
  const std::uint64_t sensors = input_.sensors != nullptr ? head_.checksum : 0;
  close_row(channels_.permit.seals(), calls_, sensors, row.permit.head.checksum, row.calls);
}

void MonitorCycle::publish(std::uint64_t run, Permit& permit) noexcept {
  permit.head = {.run = run, .cycle = clock_.cycle(), .stamp_ns = head_.stamp_ns};
  published_run_.store(run, std::memory_order_release);
  channels_.permit.publish_in_place(permit);
}

}  // namespace robot_control
