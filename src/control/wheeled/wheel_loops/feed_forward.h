#pragma once
/// Computes the torque for a planned motion by the Newton-Euler equations of a body on driven wheels, h on each side.
///
/// The body has the mass m (all links) and the yaw inertia I. The vertical of I goes through the middle of the wheels,
/// to which v and ω belong. Its centre of gravity is x_c ahead of that point. The wheels exert the force F along x and
/// the moment M about z, shared evenly by those of a side. The geometric wheel base b is the lever arm of the forces:
///
///   F = m·(v̇ − x_c·ω²)        F_left  = (F/2 − M/b)/h
///   M = I·ω̇ + m·x_c·v·ω       F_right = (F/2 + M/b)/h
///
/// A wheel of radius r and axle inertia J passes F_wheel to the ground. It is accelerated with the acceleration a of
/// its rim, which kinematics.h computes with the effective wheel base b_eff:
///
///   τ = r·F_wheel + J·a/r     (times the joint's sign)
///
/// The joint with damping d and dry friction f also needs d·q̇ + f·tanh(q̇/ε). Here ε = 0.1 rad/s approximates the
/// friction near zero speed.
///
/// The inertia of a wheel, per rad/s² of its joint, is therefore (drive_train.h)
///   straight: J + m·r²/(2·h)      turning: J + 2·I·r²/(h·b·b_eff)      lifted: J
/// With 12 kg, r = 0.1 m, J = 0.005, I = 0.5 kg·m², b = 0.5 m, h = 1: 0.065, 0.045 and 0.005 kg·m².
///
/// In a turn, wheels behind each other also need the torque of scrub.h times the friction of the ground
/// (ground_friction.h). The integrator compensates slopes.

#include "control/wheeled/planar_twist.h"
#include "machine/wheeled/drive_train.h"
#include "signals/wheeled/drive_tuning.h"

namespace robot_control {

class FeedForward {
 public:
  explicit FeedForward(const DriveTrain& robot);

  /// Sets another mass and yaw inertia, and other inertia, damping and friction per wheel.
  void tune(const DriveTuning& tuning) noexcept;

  /// Returns N·m per wheel for moving at `twist` with `acceleration` (m/s², rad/s²), joint losses included, without
  /// scrub.
  WheelValues efforts(const PlanarTwist& twist, const PlanarTwist& acceleration) const noexcept;

 private:
  double mass_;
  double yaw_inertia_;
  double centre_ahead_;  ///< m, x_c
  double wheel_base_;
  double half_base_;  ///< m, half of the effective wheel base
  std::size_t wheels_;
  WheelValues side_{};                     ///< −1 left, +1 right
  WheelValues effort_per_force_{};         ///< m: sign·r/h, effort per force of a side
  WheelValues effort_per_acceleration_{};  ///< N·m·s²/m: sign·J/r
  WheelValues turn_per_rim_{};             ///< rad/m: sign/r
  WheelValues damping_{};                  ///< N·m·s/rad
  WheelValues friction_{};                 ///< N·m
};

}  // namespace robot_control
