#pragma once
/// The speed of one axis moves to a target within limits of acceleration, deceleration and jerk, in the shortest time.
///
/// Sampled: a_k = (v_k − v_k−1)/dt, so the limits hold for what a log shows. With Δ = jerk·dt and the target at
/// distance e, in the direction of e:
///
///   F(a) = dt·(a + (a − Δ) + (a − 2Δ) + …)    change of speed while a decreases to 0 at the jerk limit, this step
///                                             included
///   G(a) = dt·(the same terms, as long as they exceed `acceleration`)
///   a_k  = the largest a with  F(a) ≤ e,  a ≤ bound,  and towards zero  G(a) ≤ |v|,   within Δ of a_k−1
///
/// bound: `acceleration` while |v| grows, `deceleration` while it shrinks. G: an acceleration above `acceleration` has
/// ended when the speed is zero. F and G are piecewise linear in a and are inverted in closed form; for F, with m =
/// e/(dt·Δ):
///
///   n = ⌊(√(1 + 8m) − 1)/2⌋,  a = (e/dt + Δ·n(n + 1)/2)/(n + 1)
///
/// So the target is reached exactly, bit for bit, with a = 0 in the next step. No limit is exceeded, and a constant
/// target is never overshot. A target that moves closer during a ramp, or changes to the other side of zero, is
/// overshot by the unavoidable a²/(2·jerk). After a limit was lowered, or an emergency has ended, the acceleration
/// returns at the jerk limit.
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
  double acceleration = 0;  ///< of the last step
};

struct AxisStep {
  AxisState state;            ///< after the step
  double acceleration = 0;    ///< of this step: its speed less the one before, over dt
  bool planned = false;       ///< no earlier acceleration is left that still has to decrease
  bool jerk_limited = false;  ///< the jerk limit slows down the approach
  bool acceleration_limited = false;
  bool jerk_yielded = false;  ///< the jerk limit was exceeded, at zero
};

/// `limits`: those of the plan. `jerk` ≥ limits.jerk: the rate at which an acceleration towards an earlier target may
/// end. `dt` > 0, s.
AxisStep axis_step(const AxisState& state, double target, const AxisLimits& limits, double jerk, double dt) noexcept;

/// |speed| shrinks on the way to `target`: `deceleration` applies.
bool slows_down(double speed, double target) noexcept;

}  // namespace robot_control
