#pragma once
/// Twist of the robot ↔ speeds of its wheels. The rims of one side have the same speed, as if coupled by a belt.
///
///   v_left = v − ω·b/2      v = (v_left + v_right)/2      q̇ᵢ = signᵢ·v_side/radiusᵢ
///   v_right = v + ω·b/2     ω = (v_right − v_left)/b
///
/// v, ω: linear and angular speed of the point between the wheels; b: the effective wheel base (RobotModel), that is
/// the geometric one for one wheel a side, which rolls without slip. Measured, v_side is the mean over the rims of a
/// side. With v = 0.5 m/s, ω = 0.2 rad/s and b = 0.5 m the rims run at 0.45 and 0.55 m/s. Each wheel has its own radius
/// and sign.

#include "control/planar_twist.h"
#include "robot/robot_model.h"

namespace robot_control {

/// The part of a joint's velocity limit that is planned with: beyond it the gate reduces the torque (hal/joint_clamp.h,
/// kTaperStart), and a loaded wheel without that torque leaves the curve.
inline constexpr double kUsableWheelSpeed = 0.9;

class DriveKinematics {
 public:
  /// At least one wheel on either side, at most kMaxWheels.
  explicit DriveKinematics(const RobotModel& robot);

  /// m/s of the rims over the ground, forward positive.
  SidePair rim_speeds(const PlanarTwist& twist) const noexcept;

  /// rad/s (or rad/s² for an acceleration) of each wheel's joint, in the joint's own sign.
  WheelValues joint_speeds(const PlanarTwist& twist) const noexcept;

  /// The inverse of `joint_speeds`.
  PlanarTwist twist(const WheelValues& joint_speeds) const noexcept;

  /// The largest s ≤ 1 for which no wheel runs faster than kUsableWheelSpeed of its joint's velocity limit at s·twist.
  /// Scaling both axes by it keeps the curvature ω/v. A velocity limit of 0 means none.
  double wheel_speed_scale(const PlanarTwist& twist) const noexcept;

  /// The largest s ≤ 1 for which no rim runs faster over the ground than `limit` [m/s] at s·twist. Keeps the
  /// curvature, too. 0 if the limit is negative or NaN.
  double rim_speed_scale(const PlanarTwist& twist, double limit) const noexcept;

 private:
  std::size_t wheels_;
  double half_base_;
  std::array<Side, kMaxWheels> side_{};
  WheelValues joint_per_rim_{};  ///< rad/m: sign/radius
  SidePair count_;               ///< wheels of each side
  SidePair rim_limit_;           ///< m/s, of each side's slowest wheel
};

}  // namespace robot_control
