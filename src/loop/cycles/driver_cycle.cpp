#include "loop/cycles/driver_cycle.h"

#include <algorithm>

#include "bus/bus.h"
#include "loop/gate_setup.h"
#include "signals/gate_digest.h"

namespace robot_control {

DriverCycle::DriverCycle(Driver& driver, const MachineModel& robot, const Channels& channels, std::int64_t period_ns,
                         Now now, const GateParameters& gate)
    : driver_(&driver),
      simulator_(simulator_of(driver)),
      channels_(channels),
      gate_(joint_limits(robot), gate, static_cast<double>(period_ns) * 1e-9),
      period_ns_(period_ns),
      now_(now),
      snapshots_(LawName::kGate),
      rows_(channels.sensors.kept()) {
  require_stop_actions(driver, gate, robot);
  announce_robot(channels_.sensors.memory()->head, robot.hash, robot.source);
}

DriverCycle::DriverCycle(const DriverCycle& other, Driver& driver, const Channels& channels) : DriverCycle(other) {
  driver_ = &driver;
  simulator_ = simulator_of(driver);
  channels_ = channels;
}

void DriverCycle::begin_run(std::uint64_t run) noexcept {
  run_ = run;
  cycle_ = 0;
  overruns_ = 0;
  slipped_ns_ = 0;
  gate_.enter_run();
  calls_.law.new_run = 1;
  rows_.for_each([](DriverTrace& row) { row = {}; });
  auto* memory = channels_.sensors.memory();
  attach_to_run(memory->head, run);
  memory->sequence.fetch_add(1, std::memory_order_release);
  futex_wake_all(memory->sequence);
}

void DriverCycle::publish_last_as(DriverState state) noexcept {
  if (cycle_ == 0) return;
  paused_ = rows_.last().sensors;
  if (paused_.driver_state != DriverState::kFault) paused_.driver_state = state;
  channels_.sensors.publish(paused_);
}

void DriverCycle::inject(const InjectedFaults& faults) noexcept {
  if (faults == injected_) return;
  injected_ = faults;
  if (simulator_ != nullptr) simulator_->inject(faults);
}

double DriverCycle::real_time_factor() const noexcept {
  const double simulated = static_cast<double>(cycle_) * static_cast<double>(period_ns_);
  return simulated / (simulated + static_cast<double>(slipped_ns_));
}

GateInput DriverCycle::latch(const SensorFrame& sensors) noexcept {
  GateInput input{.run = run_, .cycle = cycle_, .permit = &permit_, .command = &command_, .sensors = &sensors};
  if (cycle_ == 0) return input;
  const std::uint64_t last = cycle_ - 1;
  const auto command = channels_.command->find_within(run_, cycle_ - std::min(cycle_, kCommandLife), last, command_);
  input.command_found = command.lookup;
  input.command = command.frame;
  // Further back than a permit lives, to distinguish an expired permit from a missing one.
  constexpr std::uint64_t kSearched = kFrameSlots - 1;
  const auto permit = channels_.permit->find_within(run_, cycle_ - std::min(cycle_, kSearched), last, permit_);
  input.permit_found = permit.lookup;
  input.permit = permit.frame;
  return input;
}

/// A restarted monitor counts from 0.
void DriverCycle::follow_resets(const GateInput& input) noexcept {
  if (input.permit_found != Lookup::kFrame) return;
  if (resets_ && input.permit->resets_handled > *resets_) driver_->reset();
  resets_ = input.permit->resets_handled;
}

void DriverCycle::step() noexcept {
  const std::int64_t stamp_ns = next_stamp_ns();
  const std::int64_t woke_ns = now_ == nullptr ? 0 : now_();
  DriverTrace& row = rows_.begin(cycle_);
  SensorFrame& sensors = row.sensors;
  const GateInput input = latch(sensors);

  follow_resets(input);
  driver_->read(sensors);
  sensors.head = {.run = run_, .cycle = cycle_, .stamp_ns = stamp_ns};
  sensors.driver_instance = driver_instance_;
  sensors.gate = gate_.report();
  sensors.overruns = overruns_;
  sensors.slipped_ns = slipped_ns_;
  sensors.resumes = resumes_;
  sensors.held_ns = held_ns_;
  channels_.sensors.publish_in_place(sensors);
  if (now_ != nullptr) row.timing = {woke_ns - due_ns(sensors), now_() - due_ns(sensors)};

  if (simulator_ != nullptr) {
    simulator_->truth(row.truth);
    row.truth.head = {.run = run_, .cycle = cycle_, .stamp_ns = stamp_ns};
    if (channels_.truth.memory() != nullptr) channels_.truth.publish(row.truth);
  }

  const bool seals = channels_.sensors.seals();
  snapshots_.copy_if_due(gate_, calls_.law, sensors.head, seals);
  const std::span<const JointCommand> commands = gate_.step(input);
  driver_->write(commands);
  row.gate = gate_.report();
  calls_.command = used(input.command_found, *input.command);
  calls_.permit = used(input.permit_found, *input.permit);
  close_row(seals, calls_, sensors.head.checksum, seals ? digest_of(commands, row.gate) : 0, row.calls);
  ++cycle_;
}

}  // namespace robot_control
