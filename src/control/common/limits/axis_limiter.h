#pragma once
/// Moves the speed of one axis to a target within limits of acceleration, deceleration and jerk, in the shortest time.
///
/// The law is sampled: a_k = (v_k − v_k−1)/dt, so the limits hold for the values of a log. All signs below are relative
/// to the direction of the target, which is at the distance e ≥ 0. An acceleration a can decrease by Δ = jerk·dt in
/// each step, so it changes the speed by a sequence of further steps:
///
///   F(a) = dt·(a + (a − Δ) + (a − 2Δ) + … the terms above 0)                until the acceleration has ended
///   G(a) = dt·(a + (a − Δ) + (a − 2Δ) + … the terms above `acceleration`)   until it is no more than `acceleration`
///
/// The acceleration of this step is the largest one with time left to decrease:
///
///   F(a) ≤ e                   the acceleration has ended when the speed is at the target
///   a ≤ `acceleration`         while |v| grows; a ≤ `deceleration` while |v| shrinks
///   G(a) ≤ |v|                 while |v| shrinks: a is at most `acceleration` when the speed is zero and grows again
///   |a − a_k−1| ≤ Δ            the jerk limit, which has priority over the other three
///
/// F is piecewise linear in a; G is, too, with jumps. Both are inverted in closed form; for F, with m = e/(dt·Δ):
///
///   n = ⌊(√(1 + 8m) − 1)/2⌋,  a = (e/dt + Δ·n(n + 1)/2)/(n + 1)
///
/// The target is reached exactly, bit for bit, with a = 0 in the next step. No limit is exceeded while limits are
/// constant. After one was lowered, the acceleration returns to it at the jerk limit. A constant target is never
/// overshot. A target that moves closer during a ramp, or changes to the other side of zero, is overshot by the
/// unavoidable a²/(2·jerk).
///
/// After a lower jerk limit was set, an acceleration from before may decrease at the earlier, higher one, the
/// `release_jerk`. At the lower one it would overshoot its target.
///
/// The speed crosses zero only if the target has the opposite sign. Otherwise the axis stops at zero, and only there
/// the jerk may exceed its limit (AxisStep::jerk_yielded).

#include <limits>

namespace robot_control {

struct AxisLimits {
  double acceleration = 0;                                ///< m/s² or rad/s², > 0
  double deceleration = 0;                                ///< > 0
  double jerk = std::numeric_limits<double>::infinity();  ///< m/s³ or rad/s³, > 0; infinity: none
};

struct AxisState {
  double speed = 0;         ///< m/s or rad/s
  double acceleration = 0;  ///< at the beginning of the next step: 0 after arrival and after jerk_yielded
};

struct AxisStep {
  AxisState state;            ///< after the step
  double acceleration = 0;    ///< in this step: change of the speed over dt
  bool released = false;      ///< No earlier acceleration has to decrease or to change its sign any more.
  bool jerk_limited = false;  ///< The jerk limit slows down the approach.
  bool acceleration_limited = false;
  bool jerk_yielded = false;  ///< The jerk limit was exceeded at zero.
};

/// `release_jerk` ≥ limits.jerk is the rate at which an earlier acceleration may decrease. The caller returns to
/// limits.jerk once AxisStep::released is set. `dt` (s) is > 0.
AxisStep axis_step(const AxisState& state, double target, const AxisLimits& limits, double release_jerk,
                   double dt) noexcept;

/// Returns true if |speed| shrinks on the way to `target`, so that `deceleration` applies.
bool slows_down(double speed, double target) noexcept;

}  // namespace robot_control
