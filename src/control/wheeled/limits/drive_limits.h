#pragma once
/// Converts the user's limits to those of the limiter. Limits that are left out are derived from the others.
///
///   deceleration            = acceleration
///   in reverse              = forwards; its speed −min_linear_speed, but at most max_linear_speed
///   emergency deceleration  linear: f·deceleration (motion_limits.h), the larger of both directions; angular: the same
///                           factor f on its own deceleration, which keeps the curvature
///   jerk                    motion_limits.h, with the larger of both accelerations

#include "control/wheeled/drive_controller_parameters.h"
#include "control/wheeled/limits/speed_limiter.h"

namespace robot_control {

/// Returns infinity if `jerk` is 0, which means no limit.
double jerk_limit(double jerk) noexcept;

/// The parameters are within the ranges of the schema.
SpeedLimits speed_limits(const DriveControllerParameters& parameters) noexcept;

}  // namespace robot_control
