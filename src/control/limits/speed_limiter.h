#pragma once
/// Speed, acceleration, deceleration and jerk limits of the linear and the angular axis, forwards and backwards alike.
///
/// Speed: target* = s·target with the largest s ≤ 1 that meets |v| ≤ linear.speed, |ω| ≤ angular.speed.
/// On the way there: axis_limiter.h, each axis by itself, or with `keep_curvature` both together: with e = target* − x,
/// the remaining way of each axis, their limits are scaled down to
///
///   bound_i* = |e_i|·min_k(bound_k/|e_k|),   jerk_i* = |e_i|·min_k(jerk_k/|e_k|)
///
/// so that the output moves on the straight line from where it is to target*, and both axes arrive in the same step.
/// What follows from the line:
///   - from standstill and to standstill the commanded curvature ω/v is kept: a ramp stays on the path;
///   - an output and a target inside a convex set (wheel speed limits) never leave it in between.
/// A target that changes during a ramp begins a new line, which the output reaches as soon as what was left of the
/// acceleration has faded; no limit of an axis is exceeded for it.
///
/// In an emergency the stronger deceleration holds, and the turn follows the linear axis, but does not hold it up. No
/// limit depends on the direction of travel:
/// step(−x, −target) = −step(x, target). Only a seed (a measured speed) and limits that were lowered leave the output
/// outside the speed limits; from there it returns at `deceleration`.

#include <cstdint>
#include <limits>

#include "control/limits/axis_limiter.h"
#include "control/planar_twist.h"

namespace robot_control {

/// Of one axis; m/s or rad/s and its derivatives, all > 0.
struct MotionLimits {
  double speed = 1.0;
  double acceleration = 1.0;
  double deceleration = 1.0;
  double emergency_deceleration = 1.0;                    ///< ≥ deceleration
  double jerk = std::numeric_limits<double>::infinity();  ///< infinity: none
};

struct SpeedLimits {
  MotionLimits linear;
  MotionLimits angular{.speed = 2.0, .acceleration = 4.0, .deceleration = 4.0, .emergency_deceleration = 4.0};
  bool keep_curvature = true;
};

/// target*: what is left of `target` within the speed limits.
PlanarTwist within_speed(const PlanarTwist& target, const SpeedLimits& limits) noexcept;

class SpeedLimiter {
 public:
  explicit SpeedLimiter(const SpeedLimits& limits)
      : limits_(limits), fading_{.linear = limits.linear.jerk, .angular = limits.angular.jerk} {}

  /// Other limits from the next step on. An acceleration that grew under a higher jerk limit may still fade at that:
  /// a lower one would carry it past its target, and a stop past zero.
  void limit(const SpeedLimits& limits) noexcept;

  /// Continue from this motion (the measured one), at zero acceleration.
  void seed(const PlanarTwist& twist) noexcept;

  /// `target` finite; `dt` > 0, s. `emergency`: with the emergency deceleration. `part`: of the acceleration limits,
  /// > 0, ≤ 1, for a machine that cannot follow more; who slows down is never held up. Less than used_part() is
  /// approached at the jerk limit of the axis whose limit is the tighter, so that the output stays on its line.
  PlanarTwist step(const PlanarTwist& target, double dt, bool emergency = false, double part = 1) noexcept;

  PlanarTwist value() const noexcept { return {linear_.speed, angular_.speed}; }
  const PlanarTwist& acceleration() const noexcept { return acceleration_; }  ///< of the last step: m/s², rad/s²

  /// How much of the user's limits the last step took: 1 where an axis was at its acceleration or deceleration limit.
  double used_part() const noexcept;

  /// CommandReason bits of the last step: kReasonSpeedLimited, kReasonAccelerationLimited, kReasonJerkLimited,
  /// kReasonJerkYielded, kReasonCurvatureKept.
  std::uint64_t reasons() const noexcept { return reasons_; }

 private:
  double allowed_part(double part, double dt) const noexcept;

  SpeedLimits limits_;
  PlanarTwist fading_;  ///< m/s³, rad/s³: the jerk at which the acceleration of now may fade
  AxisState linear_;
  AxisState angular_;
  PlanarTwist acceleration_;
  PlanarTwist bound_{.linear = 1, .angular = 1};  ///< the user's, of the last step's accelerations
  std::uint64_t reasons_ = 0;
};

}  // namespace robot_control
