#pragma once
/// Speed and acceleration limits of the linear and the angular axis, forwards and backwards alike.
///
/// Speed: target* = s·target with the largest s ≤ 1 that meets |v| ≤ max_linear_speed, |ω| ≤ max_angular_speed.
/// Acceleration: the output moves on the straight line from where it is to target*,
///
///   x ← x + λ·(target* − x),   λ = min(1, a·dt/|Δv|, α·dt/|Δω|)
///
/// so both axes arrive together. What follows from the line:
///   - from standstill and to standstill the commanded curvature ω/v is kept: a ramp stays on the path;
///   - it never overshoots, and with λ = 1 the target is reached exactly, bit for bit;
///   - no limit depends on the direction of travel or on which axis brakes: step(−x, −target) = −step(x, target);
///   - an output and a target inside a convex set (wheel speed limits) never leave it in between.
/// Only a seed (a measured speed) can lie outside the speed limits; from there the output returns at the
/// acceleration limits.

#include <cstdint>

#include "control/planar_twist.h"

namespace robot_control {

/// All > 0.
struct SpeedLimits {
  double max_linear_speed = 1.0;          ///< m/s
  double max_angular_speed = 2.0;         ///< rad/s
  double max_linear_acceleration = 1.0;   ///< m/s²
  double max_angular_acceleration = 4.0;  ///< rad/s²
};

/// target*: what is left of `target` within the speed limits.
PlanarTwist within_speed(const PlanarTwist& target, const SpeedLimits& limits) noexcept;

class SpeedLimiter {
 public:
  explicit SpeedLimiter(const SpeedLimits& limits);

  /// Continue from this motion (the measured one), at zero acceleration.
  void seed(const PlanarTwist& twist) noexcept;

  /// `target` finite; `dt` > 0, s.
  PlanarTwist step(const PlanarTwist& target, double dt) noexcept;

  const PlanarTwist& value() const noexcept { return value_; }
  const PlanarTwist& acceleration() const noexcept { return acceleration_; }  ///< of the last step: m/s², rad/s²

  /// CommandReason bits of the last step: kReasonSpeedLimited, kReasonAccelerationLimited, kReasonCurvatureKept.
  std::uint64_t reasons() const noexcept { return reasons_; }

 private:
  SpeedLimits limits_;
  PlanarTwist value_;
  PlanarTwist acceleration_;
  std::uint64_t reasons_ = 0;
};

}  // namespace robot_control
