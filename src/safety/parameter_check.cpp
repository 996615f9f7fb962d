#include "safety/parameter_check.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace robot_control {
namespace {

using Entry = std::pair<const char*, const Condition SafetyParameters::*>;

// clang-format off
constexpr Entry kConditions[] = {
#define CAUSE(...)
#define CONDITION(id, name, ...) {#name, &SafetyParameters::name},
#define CONDITION_WITHOUT_LIMIT(id, name, ...) {#name, &SafetyParameters::name},
#include "signals/stop_causes.def"
};
// clang-format on

[[noreturn]] void refuse(const std::string& name, double value, const char* rule) {
  throw std::invalid_argument("safety monitor: " + name + " is " + std::to_string(value) + ", must be " + rule);
}

void require_positive(const std::string& name, double value) {
  if (!(value > 0 && std::isfinite(value))) refuse(name, value, "a number > 0");
}

void require_not_negative(const std::string& name, double value) {
  if (!(value >= 0 && std::isfinite(value))) refuse(name, value, "a number >= 0");
}

}  // namespace

const SafetyParameters& checked(const SafetyParameters& parameters, double period) {
  require_positive("period", period);
  if (parameters.loss_cycles == 0) refuse("loss_cycles", 0, "> 0");
  require_not_negative("heartbeat_timeout", parameters.heartbeat_timeout);
  require_not_negative("ramp_time", parameters.ramp_time);
  require_positive("standstill_speed", parameters.standstill_speed);
  require_not_negative("slow_speed", parameters.slow_speed);
  require_not_negative("clearance", parameters.clearance);
  require_not_negative("stop_delay", parameters.stop_delay.value_or(0));
  require_positive("stop_deceleration", parameters.stop_deceleration);
  for (const auto& [name, member] : kConditions) {
    const Condition& condition = parameters.*member;
    require_not_negative(std::string(name) + ".persistence", condition.persistence);
    if (condition.limit && !std::isfinite(*condition.limit)) refuse(name, *condition.limit, "a finite number");
  }
  return parameters;
}

}  // namespace robot_control
