#pragma once
/// JointLaw is the law of a drive that is given torques: it computes the torque from command and measured motion.
///
///   kEffort     τ = effort
///   kVelocity   τ = effort + damping · (velocity − q̇)
///   kImpedance  τ = effort + stiffness · (position − q) + damping · (velocity − q̇)
///   kBrake      the law of gate/brake_law.h
///
/// The torque is clamped to the joint's effort limit. An unknown mode or a number that is not finite causes braking.

#include "gate/brake_law.h"
#include "signals/joint.h"

namespace robot_control {

class JointLaw {
 public:
  /// Returns true for the modes whose torque this law computes.
  static bool computes(JointMode mode) noexcept { return mode != JointMode::kDriveVelocity; }

  /// `effort_limit` is in N·m or N and above 0.
  JointLaw(const Brake& brake, double effort_limit);

  /// Clears the state: no torque was applied, nothing is held.
  void reset() noexcept;

  /// Returns τ in N·m or N. The caller applies it over the next time step.
  double step(const JointCommand& command, double position, double velocity) noexcept;

  bool holding() const noexcept { return brake_.holding(); }

 private:
  BrakeLaw brake_;
  double effort_limit_;
  double applied_ = 0;  ///< τ of the last step
};

}  // namespace robot_control
