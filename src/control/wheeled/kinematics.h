#pragma once
/// Converts between the twist of the robot and the speeds of its wheels. The rims of one side have the same speed.
///
///   v_left = v − ω·b/2      v = (v_left + v_right)/2      q̇ᵢ = signᵢ·v_side/radiusᵢ
///   v_right = v + ω·b/2     ω = (v_right − v_left)/b
///
/// The speeds v and ω are those of the point between the wheels. The length b is the effective wheel base (DriveTrain);
/// with one wheel a side, which rolls without slip, it is the geometric one. A measured v_side is the mean over the
/// rims of a side. With v = 0.5 m/s, ω = 0.2 rad/s and b = 0.5 m the rims run at 0.45 and 0.55 m/s. Each wheel has its
/// own radius and sign.

#include "control/wheeled/planar_twist.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Plans use this share of a joint's velocity limit. Beyond it the gate reduces the torque (gate/joint_clamp.h,
/// kTaperStart), and a loaded wheel without that torque leaves the curve.
inline constexpr double kUsableWheelSpeed = 0.9;

class DriveKinematics {
 public:
  /// The robot has at least one wheel on either side and at most kMaxWheels.
  explicit DriveKinematics(const DriveTrain& robot);

  /// Returns the speeds of the rims over the ground in m/s, forward positive.
  SidePair rim_speeds(const PlanarTwist& twist) const noexcept {
    return {twist.linear - half_base_ * twist.angular, twist.linear + half_base_ * twist.angular};
  }

  /// Returns rad/s (rad/s² for an acceleration) of each wheel's joint, in the joint's own sign.
  WheelValues joint_speeds(const PlanarTwist& twist) const noexcept;

  /// Computes the inverse of `joint_speeds`.
  PlanarTwist twist(const WheelValues& joint_speeds) const noexcept;

  /// Returns the largest s ≤ 1 for which no wheel exceeds kUsableWheelSpeed of its joint's velocity limit at s·twist. A
  /// scale of both axes keeps the curvature ω/v. A velocity limit of 0 means none.
  double wheel_speed_scale(const PlanarTwist& twist) const noexcept;

  /// Returns the largest s ≤ 1 for which no rim is faster over the ground than `limit` [m/s] at s·twist. It is 0 if the
  /// limit is negative or NaN.
  double rim_speed_scale(const PlanarTwist& twist, double limit) const noexcept;

 private:
  std::size_t wheels_;
  double half_base_;
  std::array<Side, kMaxWheels> side_{};
  WheelValues joint_per_rim_{};  ///< rad/m: sign/radius
  SidePair count_;               ///< number of wheels on each side
  SidePair rim_limit_;           ///< m/s, limit of the slowest wheel of each side
};

}  // namespace robot_control
