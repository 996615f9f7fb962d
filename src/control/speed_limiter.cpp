#include "control/speed_limiter.h"

#include <algorithm>
#include <cmath>

#include "signals/command_frame.h"

namespace robot_control {

namespace {

/// The part ≤ 1 of `wish` that `limit` allows.
double allowed_part(double wish, double limit) noexcept {
  const double size = std::abs(wish);
  return size > limit ? limit / size : 1.0;
}

}  // namespace

PlanarTwist within_speed(const PlanarTwist& target, const SpeedLimits& limits) noexcept {
  const double scale = std::min(allowed_part(target.linear, limits.max_linear_speed),
                                allowed_part(target.angular, limits.max_angular_speed));
  if (scale == 1.0) return target;
  // The clamp takes back what rounding may have added to the limiting axis.
  return {std::clamp(scale * target.linear, -limits.max_linear_speed, limits.max_linear_speed),
          std::clamp(scale * target.angular, -limits.max_angular_speed, limits.max_angular_speed)};
}

SpeedLimiter::SpeedLimiter(const SpeedLimits& limits) : limits_(limits) {}

void SpeedLimiter::seed(const PlanarTwist& twist) noexcept {
  value_ = twist;
  acceleration_ = {};
  reasons_ = 0;
}

PlanarTwist SpeedLimiter::step(const PlanarTwist& target, double dt) noexcept {
  reasons_ = 0;
  const PlanarTwist goal = within_speed(target, limits_);
  if (goal.linear != target.linear || goal.angular != target.angular) {
    reasons_ |= kReasonSpeedLimited;
    if (target.linear != 0 && target.angular != 0) reasons_ |= kReasonCurvatureKept;
  }
  const PlanarTwist distance{goal.linear - value_.linear, goal.angular - value_.angular};
  const double linear_part = allowed_part(distance.linear, limits_.max_linear_acceleration * dt);
  const double angular_part = allowed_part(distance.angular, limits_.max_angular_acceleration * dt);
  const double part = std::min(linear_part, angular_part);

  PlanarTwist next = goal;
  if (part < 1.0) {
    reasons_ |= kReasonAccelerationLimited;
    if (distance.linear != 0 && distance.angular != 0 && linear_part != angular_part) reasons_ |= kReasonCurvatureKept;
    next = {value_.linear + part * distance.linear, value_.angular + part * distance.angular};
  }
  acceleration_ = {(next.linear - value_.linear) / dt, (next.angular - value_.angular) / dt};
  value_ = next;
  return value_;
}

}  // namespace robot_control
