#include "control/wheeled/limits/speed_limiter.h"

#include <algorithm>
#include <cmath>

#include "signals/command_frame.h"

namespace robot_control {

namespace {

/// Returns the largest scale ≤ 1 for which `requested` stays within `limit`.
double scale_within(double requested, double limit) noexcept {
  const double size = std::abs(requested);
  return size > limit ? limit / size : 1.0;
}

/// Returns the limits on the way from `speed` to `goal`.
AxisLimits in_force(const MotionLimits& limits, double speed, double goal, bool emergency,
                    double acceleration_scale) noexcept {
  const double deceleration = emergency ? limits.emergency_deceleration : limits.deceleration_from(speed);
  return {acceleration_scale * limits.acceleration_towards(goal - speed), deceleration, limits.jerk};
}

/// Describes the motion of one axis towards its target.
struct Approach {
  AxisLimits own;
  double distance;  ///< |distance|
  bool slows_down;

  double bound() const noexcept { return slows_down ? own.deceleration : own.acceleration; }
};

Approach approach(const AxisState& state, double goal, const AxisLimits& own) noexcept {
  return {own, std::abs(goal - state.speed), slows_down(state.speed, goal)};
}

/// Returns the limits with which `axis` arrives together with `other`.
AxisLimits together(const Approach& axis, const Approach& other) noexcept {
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
  const double linear = limits.linear.speed_towards(target.linear);
  const double angular = limits.angular.speed_towards(target.angular);
  const double scale = std::min(scale_within(target.linear, linear), scale_within(target.angular, angular));
  if (scale == 1.0) return target;
  // The clamp removes what rounding may have added to the limiting axis.
  return {std::clamp(scale * target.linear, -linear, linear), std::clamp(scale * target.angular, -angular, angular)};
}

void SpeedLimiter::set_limits(const SpeedLimits& limits) noexcept {
  limits_ = limits;
  release_jerk_ = {std::max(release_jerk_.linear, limits.linear.jerk),
                   std::max(release_jerk_.angular, limits.angular.jerk)};
}

void SpeedLimiter::restart_from(const PlanarTwist& twist) noexcept {
  linear_ = {.speed = twist.linear};
  angular_ = {.speed = twist.angular};
  acceleration_ = {};
  reasons_ = 0;
}

double SpeedLimiter::used_acceleration_scale() const noexcept {
  return std::max(std::abs(acceleration_.linear) / bound_.linear, std::abs(acceleration_.angular) / bound_.angular);
}

double SpeedLimiter::allowed_acceleration_scale(double acceleration_scale, double dt) const noexcept {
  if (acceleration_scale >= 1) return 1;
  const double rate = std::min(limits_.linear.jerk / bound_.linear, limits_.angular.jerk / bound_.angular);
  return std::clamp(used_acceleration_scale() - rate * dt, acceleration_scale, 1.0);
}

PlanarTwist SpeedLimiter::step(const PlanarTwist& target, double dt, bool emergency,
                               double requested_acceleration_scale) noexcept {
  reasons_ = 0;
  const double acceleration_scale = allowed_acceleration_scale(requested_acceleration_scale, dt);
  const PlanarTwist goal = within_speed(target, limits_);
  if (goal.linear != target.linear || goal.angular != target.angular) {
    reasons_ |= kReasonSpeedLimited;
    if (target.linear != 0 && target.angular != 0) reasons_ |= kReasonCurvatureKept;
  }
  const Approach linear_approach = approach(
      linear_, goal.linear, in_force(limits_.linear, linear_.speed, goal.linear, emergency, acceleration_scale));
  const Approach angular_approach = approach(
      angular_, goal.angular, in_force(limits_.angular, angular_.speed, goal.angular, emergency, acceleration_scale));
  const bool coupled = limits_.keep_curvature && linear_approach.distance > 0 && angular_approach.distance > 0;
  // An axis that slows down waits neither for a turn in an emergency nor for an axis that lacks torque.
  const bool linear_waits =
      coupled && !emergency && !(acceleration_scale < 1 && linear_approach.slows_down && !angular_approach.slows_down);
  const bool angular_waits =
      coupled && !(acceleration_scale < 1 && angular_approach.slows_down && !linear_approach.slows_down);
  const AxisLimits linear_plan = linear_waits ? together(linear_approach, angular_approach) : linear_approach.own;
  const AxisLimits angular_plan = angular_waits ? together(angular_approach, linear_approach) : angular_approach.own;

  const AxisStep linear = axis_step(linear_, goal.linear, linear_plan, release_jerk_.linear, dt);
  const AxisStep angular = axis_step(angular_, goal.angular, angular_plan, release_jerk_.angular, dt);
  if (linear.released) release_jerk_.linear = limits_.linear.jerk;
  if (angular.released) release_jerk_.angular = limits_.angular.jerk;
  const std::uint64_t shaped = reasons_of(linear) | reasons_of(angular);
  const bool kept = scaled(linear_plan, linear_approach.own) || scaled(angular_plan, angular_approach.own);
  if (kept && (shaped & (kReasonAccelerationLimited | kReasonJerkLimited)) != 0) reasons_ |= kReasonCurvatureKept;
  reasons_ |= shaped;
  linear_ = linear.state;
  angular_ = angular.state;
  acceleration_ = {linear.acceleration, angular.acceleration};
  bound_ = {linear_approach.bound() / (linear_approach.slows_down ? 1 : acceleration_scale),
            angular_approach.bound() / (angular_approach.slows_down ? 1 : acceleration_scale)};
  return value();
}

}  // namespace robot_control
