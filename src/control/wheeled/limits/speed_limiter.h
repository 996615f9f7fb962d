#pragma once
/// Limits speed, acceleration, deceleration and jerk of the linear and the angular axis. The limits of speed,
/// acceleration and deceleration may differ backwards (below 0).
///
/// The speed is limited to target* = s·target, with the largest s ≤ 1 for which v and ω are within their limits. The
/// ramps follow axis_limiter.h, each axis alone, or both together with `keep_curvature`. Then, with the remaining
/// distance e = target* − x of each axis, their limits are scaled down to
///
///   bound_i* = |e_i|·min_k(bound_k/|e_k|),   jerk_i* = |e_i|·min_k(jerk_k/|e_k|)
///
/// The output moves on the straight line from its present value to target*, and both axes arrive in the same step. It
/// follows that
///   - from and to standstill the commanded curvature ω/v is kept: a ramp stays on the path;
///   - an output and a target inside a convex set (wheel speed limits) stay inside it on the way.
/// A target that changes during a ramp begins a new line. The output reaches that line when the earlier acceleration
/// has ended; no limit of an axis is exceeded for it.
///
/// The acceleration is that of the direction in which the speed grows. The deceleration is that of the direction in
/// which the axis still moves. In an emergency the emergency deceleration applies in both directions, and the linear
/// axis does not wait for the angular one. With equal limits in both directions, step(−x, −target) = −step(x, target).
/// The output is outside the speed limits only after restart_from (a measured speed) and after limits were lowered. It
/// returns at `deceleration`.

#include <cstdint>

#include "control/common/limits/axis_limiter.h"
#include "control/common/limits/motion_limits.h"
#include "control/wheeled/planar_twist.h"

namespace robot_control {

struct SpeedLimits {
  MotionLimits linear;
  MotionLimits angular{.speed = 2.0, .acceleration = 4.0, .deceleration = 4.0, .emergency_deceleration = 4.0};
  bool keep_curvature = true;
};

/// Returns target*, which is `target` scaled into the speed limits.
PlanarTwist within_speed(const PlanarTwist& target, const SpeedLimits& limits) noexcept;

class SpeedLimiter {
 public:
  explicit SpeedLimiter(const SpeedLimits& limits)
      : limits_(limits), release_jerk_{.linear = limits.linear.jerk, .angular = limits.angular.jerk} {}

  /// Sets other limits from the next step on. An acceleration that was built up under a higher jerk limit may still
  /// decrease at that limit. With the lower one it would overshoot its target, and a stop would cross zero.
  void set_limits(const SpeedLimits& limits) noexcept;

  /// Continues from this measured twist at zero acceleration.
  void restart_from(const PlanarTwist& twist) noexcept;

  /// Moves towards the finite `target` over `dt` s > 0; `emergency` selects the emergency deceleration.
  /// `acceleration_scale` (> 0, ≤ 1) scales the acceleration limits for a machine that cannot follow more;
  /// decelerations are not scaled. A scale below used_acceleration_scale() is approached at the tighter jerk limit of
  /// both axes, so that the output stays on its line.
  PlanarTwist step(const PlanarTwist& target, double dt, bool emergency = false,
                   double acceleration_scale = 1) noexcept;

  PlanarTwist value() const noexcept { return {linear_.speed, angular_.speed}; }
  const PlanarTwist& acceleration() const noexcept { return acceleration_; }  ///< m/s², rad/s², in the last step

  /// Returns the share of the user's limits that the last step used: 1 if an axis was at its acceleration or
  /// deceleration limit.
  double used_acceleration_scale() const noexcept;

  /// Returns the CommandReason bits of the last step: kReasonSpeedLimited, kReasonAccelerationLimited,
  /// kReasonJerkLimited, kReasonJerkYielded, kReasonCurvatureKept.
  std::uint64_t reasons() const noexcept { return reasons_; }

 private:
  double allowed_acceleration_scale(double acceleration_scale, double dt) const noexcept;

  SpeedLimits limits_;
  PlanarTwist release_jerk_;  ///< m/s³, rad/s³: jerk at which the present acceleration may decrease
  AxisState linear_;
  AxisState angular_;
  PlanarTwist acceleration_;
  PlanarTwist bound_{.linear = 1, .angular = 1};  ///< the user's limits of the last step's accelerations
  std::uint64_t reasons_ = 0;
};

}  // namespace robot_control
