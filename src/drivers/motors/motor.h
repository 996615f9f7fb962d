#pragma once
/// What torque a motor behind a gear has left at a speed.
///
/// L is the joint's effort limit (the torque of the stalled motor, behind the gear), ω₀ = no_load_speed / gear_ratio
/// the joint's speed at which the driving torque has fallen to zero; in between it falls linearly, the torque–speed
/// line of a permanent-magnet motor at its full voltage. For q̇ ≥ 0, and mirrored for q̇ < 0:
///
///   −L ≤ τ ≤ L·max(0, 1 − q̇/ω₀)
///
/// Against the motion the whole limit is there: the motor's own voltage helps. ω₀ = 0: no such line, |τ| ≤ L.
/// Friction, damping and rotor inertia are the joint's, in the MJCF.

#include <algorithm>

namespace robot_control {

class Motor {
 public:
  /// `effort_limit` N·m; speeds rad/s; 0: no torque–speed line.
  Motor(double effort_limit, double no_load_speed, double gear_ratio) noexcept
      : effort_limit_(effort_limit), slope_(no_load_speed > 0 ? gear_ratio / no_load_speed : 0) {}

  /// τ at most in the direction of positive effort, at the velocity `along` it.
  double available(double along) const noexcept { return effort_limit_ * std::clamp(1 - slope_ * along, 0.0, 1.0); }

  /// The torque that comes of the one asked for.
  double limited(double effort, double velocity) const noexcept {
    return std::clamp(effort, -available(-velocity), available(velocity));
  }

 private:
  double effort_limit_;
  double slope_;  ///< 1/ω₀, s/rad
};

}  // namespace robot_control
