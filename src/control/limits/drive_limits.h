#pragma once
/// A user's limits → those of the limiter: what was left out follows from what was given.
///
///   deceleration            = acceleration
///   emergency deceleration  linear: f·deceleration with f = 2, less where that is more than kHalfGrip, but at least 1;
///                           angular: the factor of the linear one on its own deceleration, so that a curve stays one
///   jerk                    = max(acceleration, emergency deceleration / 2) / 0.1 s

#include "control/drive_controller_parameters.h"
#include "control/limits/speed_limiter.h"

namespace robot_control {

/// m/s², half of what dry ground of friction 1 carries.
inline constexpr double kHalfGrip = 4.9;

/// Infinite where `jerk` is 0, which users say for none.
double jerk_limit(double jerk) noexcept;

/// Within the ranges of the schema.
SpeedLimits speed_limits(const DriveControllerParameters& parameters) noexcept;

}  // namespace robot_control
