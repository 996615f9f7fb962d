#pragma once
/// One axis on its way to a target: speed within acceleration, deceleration and jerk, as fast as these allow.
///
/// Sampled, as it is carried out: a_k = (v_k − v_k−1)/dt, so what is limited is what a log shows. With Δ = jerk·dt and
/// the target at distance e, in the direction of e:
///
///   F(a) = dt·(a + (a − Δ) + (a − 2Δ) + …)    speed gained while a fades at the jerk limit, the step of a included
///   G(a) = dt·(the same, as long as the terms exceed `acceleration`)
///   a_k  = the largest a with  F(a) ≤ e,  a ≤ bound,  and towards zero  G(a) ≤ |v|,   but no further than Δ from a_k−1
///
/// bound: `acceleration` where |v| grows, `deceleration` where it shrinks; G: what is stronger than `acceleration` is
/// gone at zero. F and G are piecewise linear in a and are inverted in closed form, with m = e/(dt·Δ):
///
///   F: n = ⌊(√(1 + 8m) − 1)/2⌋,  a = (e/dt + Δ·n(n + 1)/2)/(n + 1)
///
/// So the target is reached exactly, bit for bit, with a = 0 in the step after; no limit is exceeded, and a target that
/// stays is never overshot. One that comes nearer during a ramp is, by the unavoidable a²/(2·jerk); one that changes
/// beyond zero, too. A limit that is lowered, or an emergency that is over, is returned to at the jerk limit.
///
/// Zero is crossed only by who has to: where the target does not lie beyond, the axis stops at zero, and there alone
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
  bool planned = false;       ///< nothing of an earlier acceleration is left to fade
  bool jerk_limited = false;  ///< with more jerk it would be faster there
  bool acceleration_limited = false;
  bool jerk_yielded = false;  ///< the jerk limit did, at zero
};

/// `limits`: those to plan with. `jerk` ≥ limits.jerk: how fast an acceleration that was for another target may go.
/// `dt` > 0, s.
AxisStep axis_step(const AxisState& state, double target, const AxisLimits& limits, double jerk, double dt) noexcept;

/// On the way to `target` |speed| shrinks: `deceleration` holds.
bool slows_down(double speed, double target) noexcept;

}  // namespace robot_control
