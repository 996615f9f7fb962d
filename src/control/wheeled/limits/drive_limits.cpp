#include "control/wheeled/limits/drive_limits.h"

#include <algorithm>
#include <limits>

namespace robot_control {

double jerk_limit(double jerk) noexcept {
  return jerk > 0 ? jerk : std::numeric_limits<double>::infinity();
}

SpeedLimits speed_limits(const DriveControllerParameters& parameters) noexcept {
  const double linear = parameters.max_linear_deceleration.value_or(parameters.max_linear_acceleration);
  const double reverse = parameters.max_linear_deceleration_reverse.value_or(linear);
  const double strongest = std::max(linear, reverse);
  const double reverse_acceleration =
      parameters.max_linear_acceleration_reverse.value_or(parameters.max_linear_acceleration);
  const double reverse_speed =
      std::min(-parameters.min_linear_speed.value_or(-parameters.max_linear_speed), parameters.max_linear_speed);
  const double angular = parameters.max_angular_deceleration.value_or(parameters.max_angular_acceleration);
  const double linear_emergency =
      parameters.max_linear_emergency_deceleration.value_or(derived_emergency_deceleration(strongest));
  const double angular_emergency =
      parameters.max_angular_emergency_deceleration.value_or(angular * std::max(1.0, linear_emergency / strongest));
  const double linear_jerk = parameters.max_linear_jerk.value_or(
      derived_jerk(std::max(parameters.max_linear_acceleration, reverse_acceleration), linear_emergency));
  const double angular_jerk =
      parameters.max_angular_jerk.value_or(derived_jerk(parameters.max_angular_acceleration, angular_emergency));
  return {.linear = {.speed = parameters.max_linear_speed,
                     .acceleration = parameters.max_linear_acceleration,
                     .deceleration = linear,
                     .emergency_deceleration = linear_emergency,
                     .jerk = jerk_limit(linear_jerk),
                     .reverse_speed = std::max(reverse_speed, 0.0),
                     .reverse_acceleration = reverse_acceleration,
                     .reverse_deceleration = reverse},
          .angular = {.speed = parameters.max_angular_speed,
                      .acceleration = parameters.max_angular_acceleration,
                      .deceleration = angular,
                      .emergency_deceleration = angular_emergency,
                      .jerk = jerk_limit(angular_jerk)},
          .keep_curvature = parameters.keep_curvature};
}

}  // namespace robot_control
