#pragma once
/// A Motor limits the torque of a motor behind a gear by its speed.
///
/// L is the joint's effort limit, the torque of the stalled motor behind the gear. ω₀ = no_load_speed / gear_ratio is
/// the joint's speed at which the driving torque has fallen to zero. In between it falls linearly, as in a
/// permanent-magnet motor at full voltage. The bounds for q̇ ≥ 0, mirrored for q̇ < 0, are:
///
///   −L ≤ τ ≤ L·max(0, 1 − q̇/ω₀)
///
/// Against the motion the motor has the full limit, because its induced voltage helps. Without a no-load speed (0) only
/// |τ| ≤ L applies. Friction, damping and rotor inertia are properties of the joint in the MJCF.

#include <algorithm>

namespace robot_control {

class Motor {
 public:
  /// `effort_limit` is in N·m, `no_load_speed` in rad/s; 0 means no torque–speed line.
  Motor(double effort_limit, double no_load_speed, double gear_ratio) noexcept
      : effort_limit_(effort_limit), slope_(no_load_speed > 0 ? gear_ratio / no_load_speed : 0) {}

  /// Returns the largest τ in a direction at the velocity `along` this direction.
  double available(double along) const noexcept { return effort_limit_ * std::clamp(1 - slope_ * along, 0.0, 1.0); }

  /// Returns the torque that the motor gives when `effort` is requested.
  double limited(double effort, double velocity) const noexcept {
    return std::clamp(effort, -available(-velocity), available(velocity));
  }

 private:
  double effort_limit_;
  double slope_;  ///< 1/ω₀, s/rad
};

}  // namespace robot_control
