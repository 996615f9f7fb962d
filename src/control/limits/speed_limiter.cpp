#include "control/limits/speed_limiter.h"

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

AxisLimits in_force(const MotionLimits& limits, bool emergency, double part) noexcept {
  const double deceleration = emergency ? limits.emergency_deceleration : limits.deceleration;
  return {part * limits.acceleration, deceleration, limits.jerk};
}

/// One axis on its way.
struct Way {
  AxisLimits own;
  double distance;  ///< without sign
  bool slows_down;

  double bound() const noexcept { return slows_down ? own.deceleration : own.acceleration; }
};

Way way(const AxisState& state, double goal, const AxisLimits& own) noexcept {
  return {own, std::abs(goal - state.speed), slows_down(state.speed, goal)};
}

/// The limits with which `axis` arrives together with `other`.
AxisLimits together(const Way& axis, const Way& other) noexcept {
  const double ratio = axis.distance / other.distance;
  const double bound = std::min(axis.bound(), ratio * other.bound());
  const double beyond_zero = std::min(axis.own.acceleration, ratio * other.own.acceleration);
  const double jerk = std::min(axis.own.jerk, ratio * other.own.jerk);
  return {axis.slows_down ? beyond_zero : bound, bound, jerk};
}

std::uint64_t reasons_of(const AxisStep& step) noexcept {
  std::uint64_t reasons = 0;
  if (step.acceleration_limited) reasons |= kReasonAccelerationLimited;
  if (step.jerk_limited) reasons |= kReasonJerkLimited;
  if (step.jerk_yielded) reasons |= kReasonJerkYielded;
  return reasons;
}

bool scaled(const AxisLimits& planned, const AxisLimits& own) noexcept {
  return planned.acceleration < own.acceleration || planned.deceleration < own.deceleration || planned.jerk < own.jerk;
}

}  // namespace

PlanarTwist within_speed(const PlanarTwist& target, const SpeedLimits& limits) noexcept {
  const double linear = limits.linear.speed;
  const double angular = limits.angular.speed;
  const double scale = std::min(allowed_part(target.linear, linear), allowed_part(target.angular, angular));
  if (scale == 1.0) return target;
  // The clamp takes back what rounding may have added to the limiting axis.
  return {std::clamp(scale * target.linear, -linear, linear), std::clamp(scale * target.angular, -angular, angular)};
}

void SpeedLimiter::limit(const SpeedLimits& limits) noexcept {
  limits_ = limits;
  fading_ = {std::max(fading_.linear, limits.linear.jerk), std::max(fading_.angular, limits.angular.jerk)};
}

void SpeedLimiter::seed(const PlanarTwist& twist) noexcept {
  fading_ = {limits_.linear.jerk, limits_.angular.jerk};
  linear_ = {.speed = twist.linear};
  angular_ = {.speed = twist.angular};
  acceleration_ = {};
  reasons_ = 0;
}

double SpeedLimiter::used_part() const noexcept {
  return std::max(std::abs(acceleration_.linear) / bound_.linear, std::abs(acceleration_.angular) / bound_.angular);
}

double SpeedLimiter::allowed_part(double part, double dt) const noexcept {
  if (part >= 1) return 1;
  const double fading = std::min(limits_.linear.jerk / bound_.linear, limits_.angular.jerk / bound_.angular);
  return std::clamp(used_part() - fading * dt, part, 1.0);
}

PlanarTwist SpeedLimiter::step(const PlanarTwist& target, double dt, bool emergency, double wanted_part) noexcept {
  reasons_ = 0;
  const double part = allowed_part(wanted_part, dt);
  const PlanarTwist goal = within_speed(target, limits_);
  if (goal.linear != target.linear || goal.angular != target.angular) {
    reasons_ |= kReasonSpeedLimited;
    if (target.linear != 0 && target.angular != 0) reasons_ |= kReasonCurvatureKept;
  }
  const Way linear_way = way(linear_, goal.linear, in_force(limits_.linear, emergency, part));
  const Way angular_way = way(angular_, goal.angular, in_force(limits_.angular, emergency, part));
  const bool coupled = limits_.keep_curvature && linear_way.distance > 0 && angular_way.distance > 0;
  // Who slows down waits neither for a turn in an emergency nor for an axis that lacks torque.
  const bool linear_waits = coupled && !emergency && !(part < 1 && linear_way.slows_down && !angular_way.slows_down);
  const bool angular_waits = coupled && !(part < 1 && angular_way.slows_down && !linear_way.slows_down);
  const AxisLimits linear_plan = linear_waits ? together(linear_way, angular_way) : linear_way.own;
  const AxisLimits angular_plan = angular_waits ? together(angular_way, linear_way) : angular_way.own;

  const AxisStep linear = axis_step(linear_, goal.linear, linear_plan, fading_.linear, dt);
  const AxisStep angular = axis_step(angular_, goal.angular, angular_plan, fading_.angular, dt);
  if (linear.planned) fading_.linear = limits_.linear.jerk;
  if (angular.planned) fading_.angular = limits_.angular.jerk;
  const std::uint64_t shaped = reasons_of(linear) | reasons_of(angular);
  const bool kept = scaled(linear_plan, linear_way.own) || scaled(angular_plan, angular_way.own);
  if (kept && (shaped & (kReasonAccelerationLimited | kReasonJerkLimited)) != 0) reasons_ |= kReasonCurvatureKept;
  reasons_ |= shaped;
  linear_ = linear.state;
  angular_ = angular.state;
  acceleration_ = {linear.acceleration, angular.acceleration};
  bound_ = {linear_way.slows_down ? linear_way.own.deceleration : limits_.linear.acceleration,
            angular_way.slows_down ? angular_way.own.deceleration : limits_.angular.acceleration};
  return value();
}

}  // namespace robot_control
