#pragma once
/// The torque for a planned motion: Newton-Euler equations of a body on driven wheels, h on each side.
///
/// Body of mass m (all links), yaw inertia I about the vertical through the middle of the wheels (the point that
/// v and ω belong to), centre of gravity x_c ahead of it. Force F along x and moment M about z from the wheels, shared
/// evenly by those of a side; b is the geometric wheel base, the lever arm of the forces:
///
///   F = m·(v̇ − x_c·ω²)        F_left  = (F/2 − M/b)/h
///   M = I·ω̇ + m·x_c·v·ω       F_right = (F/2 + M/b)/h
///
/// A wheel of radius r and axle inertia J passes F_wheel to the ground and is accelerated with its rim's acceleration
/// a, which kinematics.h computes with the effective wheel base b_eff:
///
///   τ = r·F_wheel + J·a/r     (times the joint's sign)
///
/// and the joint, with damping d and dry friction f, needs d·q̇ + f·tanh(q̇/ε), ε = 0.1 rad/s, an approximation of the
/// friction near zero speed.
///
/// So the inertia of a wheel, per rad/s² of its joint, is
///   straight: J + m·r²/(2·h)      turning: J + 2·I·r²/(h·b·b_eff)      lifted: J
/// With 12 kg, r = 0.1 m, J = 0.005, I = 0.5 kg·m², b = 0.5 m, h = 1: 0.065, 0.045 and 0.005 kg·m².
///
/// Wheels behind each other need the torque of scrub.h in a turn besides, times the friction of the ground
/// (ground_friction.h). Slopes are compensated by the integrator.

#include "control/planar_twist.h"
#include "robot/robot_model.h"
#include "signals/drive_tuning.h"

namespace robot_control {

/// kg·m² about the axle of one wheel.
double straight_inertia(const RobotModel& robot, const WheelModel& wheel) noexcept;
double turning_inertia(const RobotModel& robot, const WheelModel& wheel) noexcept;

class FeedForward {
 public:
  explicit FeedForward(const RobotModel& robot);

  /// Another mass, yaw inertia, and per wheel inertia, damping and friction, from now on.
  void tune(const DriveTuning& tuning) noexcept;

  /// N·m per wheel for moving at `twist` with `acceleration` (m/s², rad/s²), that of the joint included, without scrub.
  WheelValues efforts(const PlanarTwist& twist, const PlanarTwist& acceleration) const noexcept;

 private:
  double mass_;
  double yaw_inertia_;
  double centre_ahead_;  ///< m, x_c
  double wheel_base_;
  double half_base_;  ///< m, half of the effective wheel base
  std::size_t wheels_;
  WheelValues side_{};                     ///< −1 left, +1 right
  WheelValues effort_per_force_{};         ///< m: sign·r/h, of the force of a side
  WheelValues effort_per_acceleration_{};  ///< N·m·s²/m: sign·J/r
  WheelValues turn_per_rim_{};             ///< rad/m: sign/r
  WheelValues damping_{};                  ///< N·m·s/rad
  WheelValues friction_{};                 ///< N·m
};

}  // namespace robot_control
