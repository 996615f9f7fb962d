#pragma once
/// Speed, acceleration, deceleration and jerk limits of the linear and the angular axis. Speed, acceleration and
/// deceleration may differ backwards (below 0) from forwards.
///
/// Speed: target* = s·target with the largest s ≤ 1 for which v and ω are within the speeds of their directions.
/// Ramps: axis_limiter.h, for each axis alone, or with `keep_curvature` for both together. Then, with e = target* − x
/// the remaining distance of each axis, their limits are scaled down to
///
///   bound_i* = |e_i|·min_k(bound_k/|e_k|),   jerk_i* = |e_i|·min_k(jerk_k/|e_k|)
///
/// so that the output moves on the straight line from its present value to target*, and both axes arrive in the same
/// step. From this follows:
///   - from standstill and to standstill the commanded curvature ω/v is kept: a ramp stays on the path;
///   - an output and a target inside a convex set (wheel speed limits) stay inside it on the way.
/// A target that changes during a ramp begins a new line, which the output reaches as soon as the earlier acceleration
/// has ended; no limit of an axis is exceeded for it.
///
/// The acceleration that applies is that of the direction into which the speed grows, the deceleration that of the
/// direction in which the axis still moves; beyond zero, on the way to a target on the other side, the other
/// direction's acceleration. In an emergency the emergency deceleration applies in both directions, and the linear axis
/// does not wait for the angular one. With limits mirrored in forward and reverse, step(−x, −target) = −step(x,
/// target). The output is outside the speed limits only after restart_from (a measured speed) and after limits were
/// lowered; it returns at `deceleration`.

#include <cstdint>
#include <limits>
#include <optional>

#include "control/limits/axis_limiter.h"
#include "control/planar_twist.h"

namespace robot_control {

/// Limits of one axis; m/s or rad/s and derivatives, all > 0.
struct MotionLimits {
  double speed = 1.0;
  double acceleration = 1.0;
  double deceleration = 1.0;
  double emergency_deceleration = 1.0;                    ///< ≥ deceleration
  double jerk = std::numeric_limits<double>::infinity();  ///< infinity: none
  std::optional<double> reverse_speed = {};               ///< ≥ 0, of speeds below 0; absent: as forwards
  std::optional<double> reverse_acceleration = {};
  std::optional<double> reverse_deceleration = {};

  /// Those of `direction`; 0 counts as forwards.
  double speed_towards(double direction) const noexcept {
    return direction < 0 ? reverse_speed.value_or(speed) : speed;
  }
  double acceleration_towards(double direction) const noexcept {
    return direction < 0 ? reverse_acceleration.value_or(acceleration) : acceleration;
  }
  double deceleration_from(double direction) const noexcept {
    return direction < 0 ? reverse_deceleration.value_or(deceleration) : deceleration;
  }
};

struct SpeedLimits {
  MotionLimits linear;
  MotionLimits angular{.speed = 2.0, .acceleration = 4.0, .deceleration = 4.0, .emergency_deceleration = 4.0};
  bool keep_curvature = true;
};

/// target*: `target`, scaled into the speed limits.
PlanarTwist within_speed(const PlanarTwist& target, const SpeedLimits& limits) noexcept;

class SpeedLimiter {
 public:
  explicit SpeedLimiter(const SpeedLimits& limits)
      : limits_(limits), release_jerk_{.linear = limits.linear.jerk, .angular = limits.angular.jerk} {}

  /// Other limits from the next step on. An acceleration that was built up under a higher jerk limit may still decrease
  /// at that one: with the lower one it would overshoot its target, and a stop would cross zero.
  void set_limits(const SpeedLimits& limits) noexcept;

  /// Continues from this twist (the measured one), at zero acceleration.
  void restart_from(const PlanarTwist& twist) noexcept;

  /// `target` finite; `dt` > 0, s. `emergency`: use the emergency deceleration. `acceleration_scale`: of the
  /// acceleration limits, > 0, ≤ 1, for a machine that cannot follow more; decelerations are not scaled. A scale below
  /// used_acceleration_scale() is approached at the tighter of the axes' jerk limits, so that the output stays on its
  /// line.
  PlanarTwist step(const PlanarTwist& target, double dt, bool emergency = false,
                   double acceleration_scale = 1) noexcept;

  PlanarTwist value() const noexcept { return {linear_.speed, angular_.speed}; }
  const PlanarTwist& acceleration() const noexcept { return acceleration_; }  ///< of the last step: m/s², rad/s²

  /// The part of the user's limits that the last step used: 1 if an axis was at its acceleration or deceleration limit.
  double used_acceleration_scale() const noexcept;

  /// CommandReason bits of the last step: kReasonSpeedLimited, kReasonAccelerationLimited, kReasonJerkLimited,
  /// kReasonJerkYielded, kReasonCurvatureKept.
  std::uint64_t reasons() const noexcept { return reasons_; }

 private:
  double allowed_acceleration_scale(double acceleration_scale, double dt) const noexcept;

  SpeedLimits limits_;
  PlanarTwist release_jerk_;  ///< m/s³, rad/s³: the jerk at which the present acceleration may decrease
  AxisState linear_;
  AxisState angular_;
  PlanarTwist acceleration_;
  PlanarTwist bound_{.linear = 1, .angular = 1};  ///< the user's limits of the last step's accelerations
  std::uint64_t reasons_ = 0;
};

}  // namespace robot_control
