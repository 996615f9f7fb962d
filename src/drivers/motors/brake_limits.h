#pragma once
/// How hard a wheel brakes: what the user says, else what robot and time step bear.
///
///   effort      B = min(effort limit, max(B₀ − f, B₀/10)),  with F = a (m + Σ J/r²)
///                 slowing  B₀ = max(F/2, m g sin 5°, min(0.9 F, m g sin 10°)) r / n
///                 holding  B₀ = max(F/2, m g sin 10°) r / n
///   damping     d = 0.4 J/h
///   stiffness   k = 0.06 J/h²
///   hold speed  0.03 m/s / r
///
/// n drive wheels, h time step, J a wheel's inertia about its axle, r its radius, f the dry friction of joint and
/// motor, which brakes as well, m the robot's mass. a is the deceleration at which wheels lift
/// (robot/bodies/tipping.h). A robot that tips easily still stands on slopes of 10°; it slows down on them as far as it
/// does not tip, and on 5° in any case. More than the ground's friction carries is harmless, the wheel then slides.
///
/// d and k: see joint_law.h; a factor of four to its limits.

#include <string>

#include "drivers/mujoco_plant_parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

struct Brake {
  double effort = 0;       ///< N·m, while slowing
  double hold_effort = 0;  ///< N·m, while holding
  double damping = 0;      ///< N·m·s/rad
  double stiffness = 0;    ///< N·m/rad
  double hold_speed = 0;   ///< rad/s
};

/// Of the true robot's `wheel`. Throws DriverError for given values that the wheel does not bear, naming value and
/// bound. `step` = h in seconds.
Brake brake_of(const RobotModel& robot, std::size_t wheel, const MujocoPlantParameters& parameters, double step);

/// Throws DriverError unless 0 < d h / J ≤ 0.5 and 0 < k h² / J ≤ 0.5.
void check_brake(const Brake& brake, const std::string& joint, double inertia, double step);

}  // namespace robot_control
