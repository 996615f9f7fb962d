#pragma once
/// Refuses parameters with which the monitor cannot work. The ranges of a file's values are checked where it is read.

#include "safety/safety_parameters.h"

namespace robot_control {

/// Returns `parameters`. Throws std::invalid_argument, naming the first value that breaks its rule. All values and
/// limits are finite; period, stop_deceleration, standstill_speed and loss_cycles are above 0. No other time, speed or
/// distance is below 0.
const SafetyParameters& checked(const SafetyParameters& parameters, double period);

}  // namespace robot_control
