#pragma once
/// Refuses parameters with which the monitor cannot work. (The ranges of a file's values are checked where it is read.)

#include "safety/safety_parameters.h"

namespace robot_control {

/// Returns `parameters`. Throws std::invalid_argument, naming the first value that breaks its rule: period,
/// stop_deceleration or standstill_speed not above 0, another time, speed or distance below 0, loss_cycles 0, any of
/// them not finite, a limit that is not finite.
const SafetyParameters& checked(const SafetyParameters& parameters, double period);

}  // namespace robot_control
