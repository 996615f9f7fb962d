#pragma once
/// A tracked axis follows a target within a speed and an acceleration. With e the distance to the target,
///
///   wanted = clamp(sign(e) min(kFollow |e|, √(2 a |e|)), ± speed)      |Δv| ≤ a Δt
///
/// Near the target it lags by 1/kFollow seconds; farther away it brakes in time, so that it does not overshoot.

#include <algorithm>
#include <cmath>

namespace robot_control {

/// Units per s and per s².
struct AxisBounds {
  double speed = 0;
  double acceleration = 0;
};

struct TrackedAxis {
  static constexpr double kFollow = 120;  ///< 1/s

  double value = 0;
  double speed = 0;

  /// Advances by `dt` s. Returns true if a bound was reached.
  bool step(double target, const AxisBounds& bounds, double dt) noexcept {
    const double distance = target - value;
    const double free = std::min(kFollow * std::abs(distance), std::sqrt(2 * bounds.acceleration * std::abs(distance)));
    const double wanted = std::copysign(std::min(free, bounds.speed), distance);
    const double change = bounds.acceleration * dt;
    const double next = std::clamp(wanted, speed - change, speed + change);
    const bool limited = free > bounds.speed || next != wanted;
    speed = next;
    value += speed * dt;
    return limited;
  }
};

}  // namespace robot_control
