#include "control/limits/drive_limits.h"

#include <algorithm>
#include <limits>

namespace robot_control {
namespace {

constexpr double kBuildUpTime = 0.1;  // s

double derived_jerk(double acceleration, double emergency) noexcept {
  return std::max(acceleration, emergency / 2) / kBuildUpTime;
}

}  // namespace

double jerk_limit(double jerk) noexcept {
  return jerk > 0 ? jerk : std::numeric_limits<double>::infinity();
}

SpeedLimits speed_limits(const DriveControllerParameters& parameters) noexcept {
  const double linear = parameters.max_linear_deceleration.value_or(parameters.max_linear_acceleration);
  const double angular = parameters.max_angular_deceleration.value_or(parameters.max_angular_acceleration);
  const double linear_emergency =
      parameters.max_linear_emergency_deceleration.value_or(std::max(linear, std::min(2 * linear, kHalfGrip)));
  const double angular_emergency =
      parameters.max_angular_emergency_deceleration.value_or(angular * std::max(1.0, linear_emergency / linear));
  const double linear_jerk =
      parameters.max_linear_jerk.value_or(derived_jerk(parameters.max_linear_acceleration, linear_emergency));
  const double angular_jerk =
      parameters.max_angular_jerk.value_or(derived_jerk(parameters.max_angular_acceleration, angular_emergency));
  return {.linear = {.speed = parameters.max_linear_speed,
                     .acceleration = parameters.max_linear_acceleration,
                     .deceleration = linear,
                     .emergency_deceleration = linear_emergency,
                     .jerk = jerk_limit(linear_jerk)},
          .angular = {.speed = parameters.max_angular_speed,
                      .acceleration = parameters.max_angular_acceleration,
                      .deceleration = angular,
                      .emergency_deceleration = angular_emergency,
                      .jerk = jerk_limit(angular_jerk)},
          .keep_curvature = parameters.keep_curvature};
}

}  // namespace robot_control
