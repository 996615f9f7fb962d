#pragma once
/// Twist of the robot ↔ speeds of its two wheels, both rolling without slip.
///
///   v_left = v − ω·b/2      v = (v_left + v_right)/2      q̇ = sign·v_wheel/radius
///   v_right = v + ω·b/2     ω = (v_right − v_left)/b
///
/// v, ω: linear and angular speed of the point between the wheels; b: wheel_base. With v = 0.5 m/s, ω = 0.2 rad/s
/// and b = 0.5 m the rims run at 0.45 and 0.55 m/s. Each wheel has its own radius and sign (RobotModel).

#include "control/planar_twist.h"
#include "robot/robot_model.h"

namespace robot_control {

class DriveKinematics {
 public:
  explicit DriveKinematics(const RobotModel& robot);

  /// m/s of each rim over the ground, forward positive.
  WheelPair rim_speeds(const PlanarTwist& twist) const noexcept;

  /// rad/s (or rad/s² for an acceleration) of each joint, in the joint's own sign.
  WheelPair joint_speeds(const PlanarTwist& twist) const noexcept;

  /// The inverse of `joint_speeds`.
  PlanarTwist twist(const WheelPair& joint_speeds) const noexcept;

  /// The largest s ≤ 1 for which no wheel runs faster than its joint's velocity limit at s·twist. Scaling both
  /// axes by it keeps the curvature ω/v. A velocity limit of 0 means none.
  double wheel_speed_scale(const PlanarTwist& twist) const noexcept;

 private:
  double half_base_;
  WheelPair joint_per_rim_;  ///< rad/m: sign/radius
  WheelPair rim_limit_;      ///< m/s
};

}  // namespace robot_control
