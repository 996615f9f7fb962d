#include "control/common/limits/axis_limiter.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

constexpr double kJerkTolerance = 1e-12;

/// Returns the largest a with F(a) ≤ distance.
double max_acceleration_to_reach(double distance, double step, double dt) noexcept {
  const double needed = distance / dt;
  if (needed <= step) return needed;
  if (!(step > 0)) return 0;  // The distance is so short that its share of the jerk underflows.
  const double n = std::floor((std::sqrt(1 + 8 * needed / step) - 1) / 2);
  return (needed + step * n * (n + 1) / 2) / (n + 1);
}

/// Returns the largest a with G(a) ≤ distance.
double max_acceleration_before_zero(double least, double distance, double step, double dt) noexcept {
  const double needed = distance / dt;
  if (needed <= step) return std::max(least, needed);
  const double slope = 2 * least - step;
  const double n = std::floor((std::sqrt(slope * slope + 8 * step * needed) - slope) / (2 * step));
  if (n < 1) return least;
  return std::min(least + n * step, (needed + step * n * (n - 1) / 2) / n);
}

/// All values are relative to the direction of the target, which is ahead by `distance` ≥ 0.
double largest_acceleration(double speed, double distance, const AxisLimits& limits, double dt) noexcept {
  const double step = limits.jerk * dt;
  const double reaching = max_acceleration_to_reach(distance, step, dt);
  if (speed >= 0) return std::min(reaching, limits.acceleration);
  const double bound = std::min(reaching, limits.deceleration);
  if (bound <= limits.acceleration) return bound;
  return std::min(bound, max_acceleration_before_zero(limits.acceleration, -speed, step, dt));
}

bool opposite(double a, double b) noexcept {
  return (a > 0 && b < 0) || (a < 0 && b > 0);
}

}  // namespace

bool slows_down(double speed, double target) noexcept {
  return opposite(speed, target - speed);
}

AxisStep axis_step(const AxisState& state, double target, const AxisLimits& limits, double release_jerk,
                   double dt) noexcept {
  const double ahead = std::copysign(1.0, target - state.speed);
  const double distance = std::abs(target - state.speed);
  const double before = ahead * state.acceleration;
  const double aim = largest_acceleration(ahead * state.speed, distance, limits, dt);
  const double lowest = before - release_jerk * dt;
  const double highest = before < 0 ? std::max(std::min(before + release_jerk * dt, 0.0), before + limits.jerk * dt)
                                    : before + limits.jerk * dt;
  const double next = std::clamp(aim, lowest, highest);

  const double arriving = distance / dt;
  AxisStep step;
  step.state.speed = next == arriving ? target : state.speed + ahead * next * dt;
  const bool arrives = step.state.speed == target;  // Arrival by rounding counts, too.
  // An acceleration that rounding lifted above the jerk of one step would lead beyond the target.
  const bool faster = next > release_jerk * dt * (1 + kJerkTolerance);
  step.state.acceleration = ahead * (arrives && !faster ? std::min(next, release_jerk * dt) : next);
  const bool beyond_zero = state.speed == 0 ? step.state.speed != 0 : opposite(state.speed, step.state.speed);
  const bool stops = beyond_zero && (target == 0 || opposite(step.state.speed, target));
  if (stops) step.state.speed = 0;
  step.acceleration = (step.state.speed - state.speed) / dt;

  const double bound = slows_down(state.speed, target) ? limits.deceleration : limits.acceleration;
  step.released = next >= 0 && next <= aim;
  step.acceleration_limited = next < arriving && next >= bound;
  step.jerk_limited = next < arriving && next < bound;
  if (stops) {
    const double jerked = std::max(std::abs(step.acceleration - state.acceleration), std::abs(step.acceleration));
    step.jerk_yielded = jerked > release_jerk * dt;
    step.state.acceleration = step.jerk_yielded ? 0 : step.acceleration;
  }
  return step;
}

}  // namespace robot_control
