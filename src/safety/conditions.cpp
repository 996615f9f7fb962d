#include "safety/conditions.h"

#include <algorithm>
#include <cmath>

#include "safety/finite.h"

namespace robot_control {

Conditions::Conditions(const SafetyParameters& parameters, double period)
    : loss_cycles_(parameters.loss_cycles),
      heartbeat_cycles_(static_cast<std::uint64_t>(std::llround(parameters.heartbeat_timeout / period))) {
  if (parameters.heartbeat_timeout > 0) heartbeat_cycles_ = std::max<std::uint64_t>(heartbeat_cycles_, 1);
}

void Conditions::enter_run(const OperatorInput& operator_input) noexcept {
  missing_ = kMissingSensors | kMissingState | kMissingCommand;
  stepped_ = false;
  last_cycle_ = command_seen_ = state_seen_ = 0;
  corrupt_ = 0;
  not_finite_ = 0;
  heartbeat_counts_ = false;
  seen_.heartbeats = operator_input.heartbeats;
  // An inbox that began anew must not look like an event.
  seen_.e_stop_triggers = std::min(seen_.e_stop_triggers, operator_input.e_stop_triggers);
  seen_.e_stop_services = std::min(seen_.e_stop_services, operator_input.e_stop_services);
}

std::uint64_t Conditions::step(const MonitorInput& input, bool driving) noexcept {
  const SensorFrame& sensors = *input.sensors;
  const std::uint64_t cycle = sensors.head.cycle;
  const bool late = stepped_ && cycle - last_cycle_ > loss_cycles_;
  stepped_ = true;
  last_cycle_ = cycle;
  missing_ &= ~static_cast<std::uint64_t>(kMissingSensors);
  if (input.state_seen) missing_ &= ~static_cast<std::uint64_t>(kMissingState);
  if (input.command != nullptr) missing_ &= ~static_cast<std::uint64_t>(kMissingCommand);

  const bool command_awaited = (missing_ & kMissingCommand) == 0;
  const bool state_awaited = (missing_ & kMissingState) == 0;
  if (input.state_seen || !state_awaited) state_seen_ = cycle;
  if (input.command != nullptr || !command_awaited || !input.state_seen) command_seen_ = cycle;
  corrupt_ = input.corrupt ? corrupt_ + 1 : 0;
  const bool numbers_finite = finite(sensors) && (input.command == nullptr || finite(*input.command));
  not_finite_ = numbers_finite ? 0 : not_finite_ + 1;

  std::uint64_t active = operator_causes(input.operator_input);
  if ((sensors.digital_inputs & kInputEmergencyStop) != 0) active |= kCauseEmergencyStopInput;
  if (sensors.driver_state == DriverState::kFault || sensors.faults != 0) active |= kCauseDriverFault;
  if (cycle - command_seen_ >= loss_cycles_) active |= kCauseControllerLost;
  if (cycle - state_seen_ >= loss_cycles_) active |= kCauseEstimatorLost;
  if (late) active |= kCauseMonitorLate;
  if (corrupt_ >= kPersistence) active |= kCauseCorruptFrame;
  if (not_finite_ >= kPersistence) active |= kCauseNotFinite;
  if (heartbeat_lost(input.operator_input.heartbeats, sensors.head.cycle, driving)) active |= kCauseHeartbeatLost;
  return active;
}

std::uint64_t Conditions::operator_causes(const OperatorInput& operator_input) noexcept {
  std::uint64_t active = 0;
  const bool triggered = operator_input.e_stop_triggers != seen_.e_stop_triggers;
  if (operator_input.e_stop_messages != 0) e_stop_held_ = false;
  if (operator_input.e_stop_level != 0 || e_stop_held_ || triggered) active |= kCauseEmergencyStopTopic;
  if (operator_input.e_stop_services != seen_.e_stop_services) active |= kCauseEmergencyStopService;
  seen_.e_stop_triggers = operator_input.e_stop_triggers;
  seen_.e_stop_services = operator_input.e_stop_services;
  return active;
}

bool Conditions::heartbeat_lost(std::uint64_t heartbeats, std::uint64_t cycle, bool driving) noexcept {
  if (heartbeat_cycles_ == 0) return false;
  if (heartbeats != seen_.heartbeats || (driving && !heartbeat_counts_)) {
    seen_.heartbeats = heartbeats;
    beat_cycle_ = cycle;
    heartbeat_counts_ = true;
  }
  return heartbeat_counts_ && cycle - beat_cycle_ > heartbeat_cycles_;
}

}  // namespace robot_control
