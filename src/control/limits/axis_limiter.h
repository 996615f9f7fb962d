#pragma once
/// The speed of one axis moves to a target within limits of acceleration, deceleration and jerk, in the shortest time.
///
/// Sampled: a_k = (v_k − v_k−1)/dt, so the limits hold for what a log shows. All signs below are those of the direction
/// of the target, which is at the distance e ≥ 0. An acceleration a can decrease by Δ = jerk·dt in each step, so it
/// still changes the speed by a whole sequence of steps:
///
///   F(a) = dt·(a + (a − Δ) + (a − 2Δ) + … the terms above 0)                until the acceleration has ended
///   G(a) = dt·(a + (a − Δ) + (a − 2Δ) + … the terms above `acceleration`)   until it is no more than `acceleration`
///
/// The acceleration of this step is the largest one that leaves time to decrease:
///
///   F(a) ≤ e                   it has ended when the speed is at the target
///   a ≤ `acceleration`         while |v| grows; a ≤ `deceleration` while |v| shrinks
///   G(a) ≤ |v|                 while |v| shrinks: it is no more than `acceleration` when the speed is zero, beyond
///                              which |v| grows
///   |a − a_k−1| ≤ Δ            the jerk limit, which goes before the other three
///
/// F is piecewise linear in a, G too with jumps; both are inverted in closed form; for F, with m = e/(dt·Δ):
///
///   n = ⌊(√(1 + 8m) − 1)/2⌋,  a = (e/dt + Δ·n(n + 1)/2)/(n + 1)
///
/// So the target is reached exactly, bit for bit, with a = 0 in the next step. No limit is exceeded while limits are
/// constant; after one was lowered, the acceleration returns to it at the jerk limit. A constant
/// target is never overshot. A target that moves closer during a ramp, or changes to the other side of zero, is
/// overshot by the unavoidable a²/(2·jerk).
///
/// Two jerk limits: after a lower one was set, an acceleration from before may decrease at the earlier, higher one, the
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
  double acceleration = 0;  ///< with which the next step begins: 0 after arrival and after jerk_yielded
};

struct AxisStep {
  AxisState state;            ///< after the step
  double acceleration = 0;    ///< of this step: its speed less the one before, over dt
  bool released = false;      ///< no earlier acceleration has to decrease, or to change its sign, any more
  bool jerk_limited = false;  ///< the jerk limit slows down the approach
  bool acceleration_limited = false;
  bool jerk_yielded = false;  ///< the jerk limit was exceeded, at zero
};

/// `release_jerk` ≥ limits.jerk: an earlier acceleration may decrease at this rate. The caller returns to limits.jerk
/// once AxisStep::released. `dt` > 0, s.
AxisStep axis_step(const AxisState& state, double target, const AxisLimits& limits, double release_jerk,
                   double dt) noexcept;

/// |speed| shrinks on the way to `target`: `deceleration` applies.
bool slows_down(double speed, double target) noexcept;

}  // namespace robot_control
