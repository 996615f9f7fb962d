#pragma once
/// A user's limits → those of the limiter: what was left out follows from what was given.

#include "control/drive_controller_parameters.h"
#include "control/speed_limiter.h"

namespace robot_control {

/// Infinite where `jerk` is 0, which users say for none.
double jerk_limit(double jerk) noexcept;

/// Within the ranges of the schema.
SpeedLimits speed_limits(const DriveControllerParameters& parameters) noexcept;

}  // namespace robot_control
