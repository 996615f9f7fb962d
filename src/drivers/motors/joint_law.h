#pragma once
/// What a simulated drive does with a joint command: torque from command and measured motion.
///
///   kEffort     τ = effort
///   kVelocity   τ = effort + damping · (velocity − q̇)
///   kImpedance  τ = effort + stiffness · (position − q) + damping · (velocity − q̇)
///
/// clamped to the joint's effort limit.
///
/// kBrake, bounded by B, the effort or hold effort of a Brake (brake_limits.h):
///
///   slowing   τ = −d q̇
///   holding   τ = k (q* − q) − d q̇,   where the bound is reached, q* follows so that τ = ±B
///
/// d its damping, k its stiffness. The brake holds from |q̇| ≤ its hold speed on, or when within
/// 50 steps a load has kept the unsaturated speed from falling by a tenth (on a slope, damping alone would creep for
/// ever), or has raised the saturated one (on a steeper slope, the bound for slowing is not enough). Holding begins
/// with the torque that was applied last, q* = q + (τ₋ + d q̇)/k: the hand-over from a drive that held the robot on a
/// slope, or from slowing, has no jolt and no sag. Once holding it stays so, as a dry brake does: a load above B drags
/// it with the torque B.
///
/// An unknown mode, or a number that is not finite, brakes.
///
/// Stability: the torque is computed at t and applied over [t, t + h], the wheel (inertia J about the axle, off the
/// ground: the lightest case) integrates semi-implicitly:
///
///   q̇' = q̇ − a q̇ − (b/h) q,  q' = q + h q̇'     a = d h / J,  b = k h² / J
///
/// with characteristic polynomial z² − (2 − a − b) z + (1 − a), stable for 2a + b < 4. `check_brake` asks for
/// 0 < a ≤ 0.5 and 0 < b ≤ 0.5, which leaves a factor of 2.7 to the limit. The defaults: a = 0.4, b = 0.06, damping
/// ratio d / (2 √(k J)) = 0.8.

#include "drivers/motors/brake_limits.h"
#include "signals/joint.h"

namespace robot_control {

class JointLaw {
 public:
  /// `effort_limit` in N·m or N, above 0.
  JointLaw(const Brake& brake, double effort_limit);

  /// Forgets what was applied and held.
  void reset() noexcept;

  /// τ, N·m or N. The caller applies it over the next time step.
  double step(const JointCommand& command, double position, double velocity) noexcept;

  bool holding() const noexcept { return holding_; }

 private:
  double brake(double position, double velocity) noexcept;
  bool speed_stays(double speed) noexcept;

  Brake brake_;
  double effort_limit_;
  double applied_ = 0;    ///< τ of the last step
  double reference_ = 0;  ///< q*
  bool braking_ = false;
  bool holding_ = false;
  int steps_since_mark_ = 0;
  double marked_speed_ = 0;
};

}  // namespace robot_control
