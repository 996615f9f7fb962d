#include "control/legged/walk/twist_limiter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/common/limits/stop_distance.h"
#include "control/legged/walk/gait_table.h"
#include "signals/command_frame.h"
#include "signals/legged/legged_command.h"

namespace robot_control {
namespace {

MotionLimits axis(double speed, double acceleration) noexcept {
  const double emergency = derived_emergency_deceleration(acceleration);
  return {.speed = speed,
          .acceleration = acceleration,
          .deceleration = acceleration,
          .emergency_deceleration = emergency,
          .jerk = derived_jerk(acceleration, emergency)};
}

}  // namespace

std::array<MotionLimits, 3> twist_limits(const LegControllerParameters& parameters) noexcept {
  return {axis(parameters.max_linear_speed, parameters.max_linear_acceleration),
          axis(parameters.max_lateral_speed, parameters.max_lateral_acceleration),
          axis(parameters.max_angular_speed, parameters.max_angular_acceleration)};
}

double walking_stop_distance(const LegControllerParameters& parameters, double leg_length, double speed,
                             bool emergency) noexcept {
  const MotionLimits ahead = twist_limits(parameters)[0];
  const double deceleration = emergency ? ahead.emergency_deceleration : ahead.deceleration;
  const Gait gait = kGaits[kFastGait].scaled(leg_length);
  return stop_distance(speed, deceleration, ahead.jerk) + std::abs(speed) * gait.period / 2;
}

WalkingTwist TwistLimiter::step(State& state, const WalkingTwist& target, const WalkingTwist& capable, bool emergency,
                                double dt, std::uint64_t& reasons) const noexcept {
  double scale = 1, used = 0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    const double size = std::abs(target[i]);
    if (size > limits_[i].speed) scale = std::min(scale, limits_[i].speed / size);
    used += size / capable[i];
  }
  if (scale < 1) reasons |= kReasonSpeedLimited;
  if (scale * used > 1) {
    scale = 1 / used;
    reasons |= kReasonLegSpeed;
  }

  std::array<AxisLimits, 3> own;
  std::array<double, 3> distance{}, bound{};
  double rate = std::numeric_limits<double>::infinity(), jerk = rate;  // of all axes, per unit of their distances
  for (std::size_t i = 0; i < target.size(); ++i) {
    const MotionLimits& limits = limits_[i];
    const double goal = scale * target[i], speed = state.axes[i].speed;
    own[i] = {limits.acceleration, emergency ? limits.emergency_deceleration : limits.deceleration, limits.jerk};
    distance[i] = std::abs(goal - speed);
    bound[i] = slows_down(speed, goal) ? own[i].deceleration : own[i].acceleration;
    if (distance[i] == 0 || emergency) continue;
    rate = std::min(rate, bound[i] / distance[i]);
    jerk = std::min(jerk, own[i].jerk / distance[i]);
  }
  WalkingTwist result{};
  for (std::size_t i = 0; i < target.size(); ++i) {
    AxisLimits plan = own[i];
    if (distance[i] > 0 && !emergency) {
      const double together = rate * distance[i];
      plan = {std::min(own[i].acceleration, together), std::min(own[i].deceleration, together), jerk * distance[i]};
    }
    const AxisStep step = axis_step(state.axes[i], scale * target[i], plan, own[i].jerk, dt);
    state.axes[i] = step.state;
    if (step.acceleration_limited) reasons |= kReasonAccelerationLimited;
    if (step.jerk_limited) reasons |= kReasonJerkLimited;
    if (step.jerk_yielded) reasons |= kReasonJerkYielded;
    result[i] = step.state.speed;
  }
  return result;
}

}  // namespace robot_control
