#include "safety/parameter_check.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace robot_control {
namespace {

using Entry = std::pair<const char*, const Condition SafetyParameters::*>;

constexpr Entry kConditions[] = {
    {"wheel_speed", &SafetyParameters::wheel_speed},
    {"wheel_acceleration", &SafetyParameters::wheel_acceleration},
    {"wheel_effort", &SafetyParameters::wheel_effort},
    {"power", &SafetyParameters::power},
    {"torque_oscillation", &SafetyParameters::torque_oscillation},
    {"stall", &SafetyParameters::stall},
    {"runaway", &SafetyParameters::runaway},
    {"wrong_direction", &SafetyParameters::wrong_direction},
    {"not_stopping", &SafetyParameters::not_stopping},
    {"yaw_rate", &SafetyParameters::yaw_rate},
    {"tilt", &SafetyParameters::tilt},
    {"tip_over", &SafetyParameters::tip_over},
    {"free_fall", &SafetyParameters::free_fall},
    {"lift", &SafetyParameters::lift},
    {"impact", &SafetyParameters::impact},
    {"encoders_lost", &SafetyParameters::encoders_lost},
    {"imu_lost", &SafetyParameters::imu_lost},
    {"imu_stuck", &SafetyParameters::imu_stuck},
    {"overruns", &SafetyParameters::overruns},
    {"battery_low", &SafetyParameters::battery_low},
    {"battery_empty", &SafetyParameters::battery_empty},
};

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
  require_not_negative("stop_delay", parameters.stop_delay);
  require_positive("stop_deceleration", parameters.stop_deceleration);
  for (const auto& [name, member] : kConditions) {
    const Condition& condition = parameters.*member;
    require_not_negative(std::string(name) + ".persistence", condition.persistence);
    if (condition.limit && !std::isfinite(*condition.limit)) refuse(name, *condition.limit, "a finite number");
  }
  return parameters;
}

}  // namespace robot_control
