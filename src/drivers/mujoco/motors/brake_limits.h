#pragma once
/// The brake of a simulated drive, with the values that the user sets instead. That of a wheel is the kind's own
/// (TrueWheel::brake). That of another joint has the effort limit of the joint and
///
///   damping d = 0.4 J/h     stiffness k = 0.06 J/h²     hold speed 0.03 rad/s or m/s
///
/// J is the inertia of the joint's body about the joint's axis, its mass for a prismatic joint, and the rotor. The load
/// behind it only adds to J, so that d and k are four times below the limits of brake_law.h.

#include <string>

#include "drivers/joint_law.h"
#include "drivers/mujoco/model/true_robot.h"
#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "gate/brake_law.h"

namespace robot_control {

/// Returns the brake of a driven joint of the true robot; `step` is h in s. Throws DriverError, with value and bound,
/// for a given value that is not stable.
Brake brake_of(const TrueRobot& robot, std::size_t joint, const MujocoPlantParameters& parameters, double step);

/// Returns J of a driven joint in kg·m² or kg.
double inertia_of(const TrueRobot& robot, std::size_t joint, const MujocoPlantParameters& parameters);

/// Throws DriverError unless 0 < d h / J ≤ 0.5 and 0 < k h² / J ≤ 0.5.
void check_brake(const Brake& brake, const std::string& joint, double inertia, double step);

}  // namespace robot_control
