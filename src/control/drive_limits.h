#pragma once
/// A user's limits → those of the limiter: what was left out follows from what was given.

#include "control/drive_controller_parameters.h"
#include "control/speed_limiter.h"

namespace robot_control {

/// Within the ranges of the schema.
SpeedLimits speed_limits(const DriveControllerParameters& parameters) noexcept;

}  // namespace robot_control
