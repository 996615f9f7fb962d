#pragma once
/// brake_of computes how hard a wheel brakes. Values that the user does not set are derived from robot and time step:
///
///   effort      B = min(effort limit, max(B₀ − f, B₀/10)),  with F = a (m + Σ J/r²)
///                 slowing  B₀ = max(F/2, m g sin 5°, min(0.9 F, m g sin 10°)) r / n
///                 holding  B₀ = max(F/2, m g sin 10°) r / n
///   damping     d = 0.4 J/h
///   stiffness   k = 0.06 J/h²
///   hold speed  0.03 m/s / r
///
/// The robot has n drive wheels and the mass m. A wheel has the inertia J about its axle and the radius r; h is the
/// time step. The dry friction f of joint and motor also brakes. At the deceleration a wheels lift
/// (machine/bodies/tipping.h). A robot that tips easily is still held on slopes of 10°. It slows down on slopes of 5°,
/// and on steeper ones as far as it does not tip. A torque above the ground's friction is harmless, because the wheel
/// then slides.
///
/// d and k are four times below the stability limits of joint_law.h.

#include <string>

#include "drivers/joint_law.h"
#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "machine/robot_model.h"

namespace robot_control {

/// Returns the brake of a wheel of the true robot; `step` is h in s. Throws DriverError, with value and bound, for a
/// given value that is not stable.
Brake brake_of(const RobotModel& robot, std::size_t wheel, const MujocoPlantParameters& parameters, double step);

/// Throws DriverError unless 0 < d h / J ≤ 0.5 and 0 < k h² / J ≤ 0.5.
void check_brake(const Brake& brake, const std::string& joint, double inertia, double step);

}  // namespace robot_control
