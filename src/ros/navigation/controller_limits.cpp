#include "ros/navigation/controller_limits.h"

#include <algorithm>

namespace robot_control::navigation {
namespace {

template <class Controller>
DriveLimits limits_within(const Controller& controller) {
  DriveLimits limits;
  limits.forward = controller.max_linear_speed;
  limits.reverse = std::min(limits.reverse, controller.max_linear_speed);
  limits.angular = std::min(limits.angular, controller.max_angular_speed);
  limits.linear_acceleration = controller.max_linear_acceleration;
  limits.angular_acceleration = controller.max_angular_acceleration;
  return limits;
}

}  // namespace

DriveLimits limits_of(const DriveControllerParameters& wheels) {
  DriveLimits limits = limits_within(wheels);
  limits.reverse = std::min(limits.reverse, -wheels.min_linear_speed.value_or(-limits.reverse));
  for (const auto& other :
       {wheels.max_linear_deceleration, wheels.max_linear_acceleration_reverse, wheels.max_linear_deceleration_reverse})
    limits.linear_acceleration = std::min(limits.linear_acceleration, other.value_or(limits.linear_acceleration));
  limits.angular_acceleration =
      std::min(limits.angular_acceleration, wheels.max_angular_deceleration.value_or(limits.angular_acceleration));
  return limits;
}

DriveLimits limits_of(const LegControllerParameters& legs) {
  DriveLimits limits = limits_within(legs);
  limits.lateral = std::min(kMaxLateral, legs.max_lateral_speed);
  return limits;
}

void take_over(const dynamic_reconfigure::Config& message, DriveControllerParameters& wheels) {
  for (const Key& key : keys(wheels)) {
    for (const auto& entry : message.doubles) {
      if (entry.name != key.name || !key.group.empty() || !(entry.value >= key.min && entry.value <= key.max)) continue;
      if (auto* const* value = std::get_if<double*>(&key.field)) **value = entry.value;
      if (auto* const* value = std::get_if<std::optional<double>*>(&key.field)) **value = entry.value;
    }
  }
}

}  // namespace robot_control::navigation
