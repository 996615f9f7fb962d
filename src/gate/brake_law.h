#pragma once
/// BrakeLaw is the law of a drive that brakes its joint (JointMode::kBrake), for drives that are given torques. It is
/// bounded by B, the effort or hold effort of a Brake:
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
/// With the joint's inertia J and the time step h, the law is stable for 2a + b < 4, where a = d h / J and b = k h² / J
/// (docs/simulation.md). Drivers require a ≤ 0.5 and b ≤ 0.5.

namespace robot_control {

struct Brake {
  double effort = 0;       ///< N·m, while slowing
  double hold_effort = 0;  ///< N·m, while holding
  double damping = 0;      ///< N·m·s/rad
  double stiffness = 0;    ///< N·m/rad
  double hold_speed = 0;   ///< rad/s
};

class BrakeLaw {
 public:
  /// Stiffness above 0; efforts ≥ 0.
  explicit BrakeLaw(const Brake& brake) noexcept : brake_(brake) {}

  /// Returns τ in N·m. `applied` is the torque of the last time step, braked or not.
  double step(double applied, double position, double velocity) noexcept;

  /// Ends the braking: another command moves the joint.
  void release() noexcept { braking_ = holding_ = false; }

  bool holding() const noexcept { return holding_; }

 private:
  bool speed_stays(double speed) noexcept;

  Brake brake_;
  double reference_ = 0;  ///< q*
  bool braking_ = false;
  bool holding_ = false;
  int steps_since_mark_ = 0;
  double marked_speed_ = 0;
};

}  // namespace robot_control
