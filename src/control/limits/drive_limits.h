#pragma once
/// Converts the user's limits to those of the limiter. Limits that are left out are derived from the others.
///
///   deceleration            = acceleration
///   in reverse              = forwards; its speed −min_linear_speed, but at most max_linear_speed
///   emergency deceleration  linear: f·deceleration, the larger of both directions, with f = 2, less if that exceeds
///                           kHalfGrip, but at least 1; angular: the same factor f on its own deceleration, which keeps
///                           the curvature
///   jerk                    = max(accelerations, emergency deceleration / 2) / 0.1 s

#include "control/drive_controller_parameters.h"
#include "control/limits/speed_limiter.h"

namespace robot_control {

/// This is half of what dry ground of friction 1 carries, in m/s².
inline constexpr double kHalfGrip = 4.9;

/// Returns infinity if `jerk` is 0, which means no limit.
double jerk_limit(double jerk) noexcept;

/// The parameters are within the ranges of the schema.
SpeedLimits speed_limits(const DriveControllerParameters& parameters) noexcept;

}  // namespace robot_control
