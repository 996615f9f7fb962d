#pragma once
/// JointLaw computes the torque of a joint from its command and the measured motion. Drivers use it for drives that
/// follow a torque, and for simulated drives.
///
///   kEffort     τ = effort
///   kVelocity   τ = effort + damping · (velocity − q̇)
///   kImpedance  τ = effort + stiffness · (position − q) + damping · (velocity − q̇)
///
/// The torque is clamped to the joint's effort limit.
///
/// kBrake is bounded by B, the effort or hold effort of a Brake:
///
///   slowing   τ = −d q̇
///   holding   τ = k (q* − q) − d q̇,   where the bound is reached, q* follows so that τ = ±B
///
/// d is the brake's damping, k its stiffness. The brake begins to hold in three cases:
///
///   |q̇| reaches the hold speed;
///   below the bound, a load keeps the speed from falling by a tenth in 50 steps (on a slope, damping alone creeps);
///   at the bound, the speed grows within 50 steps (on a steeper slope, the bound for slowing is too small).
///
/// Holding begins with the last applied torque, q* = q + (τ₋ + d q̇)/k, so that it takes over a load on a slope without
/// a jolt. The brake then continues to hold, as a dry brake does; a load above B moves it against the torque B.
///
/// An unknown mode or a number that is not finite causes braking.
///
/// With a wheel's inertia J and the time step h, the law is stable for 2a + b < 4, where a = d h / J and b = k h² / J
/// (docs/simulation.md). The simulated machine takes a = 0.4 and b = 0.06 (mujoco/motors/brake_limits.h).

#include "signals/joint.h"

namespace robot_control {

/// How hard a joint brakes.
struct Brake {
  double effort = 0;       ///< N·m, while slowing
  double hold_effort = 0;  ///< N·m, while holding
  double damping = 0;      ///< N·m·s/rad
  double stiffness = 0;    ///< N·m/rad
  double hold_speed = 0;   ///< rad/s
};

class JointLaw {
 public:
  /// `effort_limit` is in N·m or N and above 0.
  JointLaw(const Brake& brake, double effort_limit);

  /// Clears the state: no torque was applied, nothing is held.
  void reset() noexcept;

  /// Returns τ in N·m or N. The caller applies it over the next time step.
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
