#include "control/drive_limits.h"

#include <limits>

namespace robot_control {

double jerk_limit(double jerk) noexcept {
  return jerk > 0 ? jerk : std::numeric_limits<double>::infinity();
}

SpeedLimits speed_limits(const DriveControllerParameters& parameters) noexcept {
  const double linear = parameters.max_linear_deceleration.value_or(parameters.max_linear_acceleration);
  const double angular = parameters.max_angular_deceleration.value_or(parameters.max_angular_acceleration);
  return {.linear = {.speed = parameters.max_linear_speed,
                     .acceleration = parameters.max_linear_acceleration,
                     .deceleration = linear,
                     .emergency_deceleration = parameters.max_linear_emergency_deceleration,
                     .jerk = jerk_limit(parameters.max_linear_jerk)},
          .angular = {.speed = parameters.max_angular_speed,
                      .acceleration = parameters.max_angular_acceleration,
                      .deceleration = angular,
                      .emergency_deceleration = parameters.max_angular_emergency_deceleration,
                      .jerk = jerk_limit(parameters.max_angular_jerk)},
          .keep_curvature = parameters.keep_curvature};
}

}  // namespace robot_control
