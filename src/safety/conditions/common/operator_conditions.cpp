#include "safety/conditions/common/operator_conditions.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

OperatorConditions::OperatorConditions(double heartbeat_timeout, double period) noexcept
    : period_(period),
      heartbeat_timeout_(heartbeat_timeout),
      heartbeat_cycles_(static_cast<std::uint64_t>(std::llround(heartbeat_timeout / period))) {
  if (heartbeat_timeout > 0) heartbeat_cycles_ = std::max<std::uint64_t>(heartbeat_cycles_, 1);
}

void OperatorConditions::enter_run(const OperatorInput& operator_input) noexcept {
  heartbeat_counts_ = false;
  seen_.heartbeats = operator_input.heartbeats;
  // A restarted inbox must not look like an event.
  seen_.e_stop_triggers = std::min(seen_.e_stop_triggers, operator_input.e_stop_triggers);
  seen_.e_stop_services = std::min(seen_.e_stop_services, operator_input.e_stop_services);
}

void OperatorConditions::step(const MonitorInput& input, bool driving, ActiveCauses& out) noexcept {
  const std::uint64_t stops = emergency_stops(input.operator_input);
  if ((stops & kCauseEmergencyStopTopic) != 0) out.add(kCauseEmergencyStopTopic, Reaction::kBrake);
  if ((stops & kCauseEmergencyStopService) != 0) out.add(kCauseEmergencyStopService, Reaction::kBrake);
  if (input.sensors == nullptr) return;
  if ((input.sensors->digital_inputs & kInputEmergencyStop) != 0) {
    out.add(kCauseEmergencyStopInput, Reaction::kBrake);
  }
  const std::uint64_t cycle = input.sensors->head.cycle;
  if (!heartbeat_lost(input.operator_input.heartbeats, cycle, driving)) return;
  out.add(kCauseHeartbeatLost, Reaction::kRamp,
          {.beyond = true, .value = static_cast<double>(cycle - beat_cycle_) * period_, .limit = heartbeat_timeout_});
}

std::uint64_t OperatorConditions::emergency_stops(const OperatorInput& operator_input) noexcept {
  std::uint64_t active = 0;
  const bool triggered = operator_input.e_stop_triggers != seen_.e_stop_triggers;
  if (operator_input.e_stop_messages != 0) e_stop_held_ = false;
  if (operator_input.e_stop_level != 0 || e_stop_held_ || triggered) active |= kCauseEmergencyStopTopic;
  if (operator_input.e_stop_services != seen_.e_stop_services) active |= kCauseEmergencyStopService;
  seen_.e_stop_triggers = operator_input.e_stop_triggers;
  seen_.e_stop_services = operator_input.e_stop_services;
  return active;
}

bool OperatorConditions::heartbeat_lost(std::uint64_t heartbeats, std::uint64_t cycle, bool driving) noexcept {
  if (heartbeat_cycles_ == 0) return false;
  if (heartbeats != seen_.heartbeats || (driving && !heartbeat_counts_)) {
    seen_.heartbeats = heartbeats;
    beat_cycle_ = cycle;
    heartbeat_counts_ = true;
  }
  return heartbeat_counts_ && cycle - beat_cycle_ > heartbeat_cycles_;
}

}  // namespace robot_control
