#include "safety/conditions/common/presence.h"

namespace robot_control {

void Presence::step(const MonitorInput& input, std::uint64_t elapsed, ActiveCauses& out) noexcept {
  const std::uint64_t cycle = input.sensors->head.cycle;
  const CommandFrame* command = input.command;
  missing_ &= ~static_cast<std::uint64_t>(kMissingSensors);
  if (input.state != nullptr) missing_ &= ~static_cast<std::uint64_t>(kMissingState);
  if (command != nullptr) missing_ &= ~static_cast<std::uint64_t>(kMissingCommand);
  if (!complete_) {
    missing_ &= ~static_cast<std::uint64_t>(kMissingGate);
    if (!gate_finds_both(input)) missing_ |= kMissingGate;
    complete_ = missing_ == 0;
  }

  const bool command_awaited = (missing_ & kMissingCommand) == 0;
  const bool state_awaited = (missing_ & kMissingState) == 0;
  if (input.state != nullptr || !state_awaited) state_seen_ = cycle;
  if (command != nullptr || !command_awaited || input.state == nullptr) command_seen_ = cycle;
  if (command != nullptr && input.state != nullptr) {
    stale_ = command->state_cycle == command->head.cycle ? 0 : stale_ + elapsed;
  }
  skipped_ += elapsed - 1;
  add_if_lost(kCauseControllerLost, cycle - command_seen_, out);
  add_if_lost(kCauseEstimatorLost, cycle - state_seen_, out);
  add_if_lost(kCauseCommandStale, stale_, out);
  if (elapsed > loss_cycles_) add_if_lost(kCauseMonitorLate, elapsed, out);
  if (state_seen_ == cycle && command_seen_ == cycle && stale_ == 0) skipped_ = 0;
}

bool Presence::gate_finds_both(const MonitorInput& input) const noexcept {
  const GateReport& gate = input.sensors->gate;
  if ((gate.reasons & kGateFirstTick) != 0) return true;
  return (gate.reasons & kGateNoPermit) == 0 && ((missing_ & kMissingCommand) != 0 || gate.command_cycle != 0);
}

void Presence::add_if_lost(StopCause cause, std::uint64_t cycles, ActiveCauses& out) const noexcept {
  if (cycles < loss_cycles_) return;
  out.add(2 * skipped_ >= cycles ? kCauseMonitorLate : cause, Reaction::kBrake,
          {.beyond = true, .value = static_cast<double>(cycles), .limit = static_cast<double>(loss_cycles_)});
}

}  // namespace robot_control
