#pragma once
/// The brake of a simulated drive, with the values that the user sets for driven joints instead. That of a wheel is the
/// kind's own (TrueWheel::brake). That of another joint has the effort limit of the joint and
///
///   damping d = 0.4 J/h     stiffness k = 0.06 J/h²     hold speed 0.03 rad/s or m/s
///
/// J is the inertia of the joint's body about the joint's axis, its mass for a prismatic joint, and the rotor. The load
/// behind it only adds to J, so that d and k are four times below the limits of brake_law.h.
///
/// J of a held joint is that of its rotor alone. The joints of an arm brake together, and each is light where its
/// neighbours give way. But the machine's mass matrix is at least that of the rotors, so that all brakes together are
/// as stable as each by itself. Under its full effort limit such a joint gives way by 200 rad/s² · h²/0.06, 3.3 mrad
/// (or mm) at 1 kHz.

#include <string>

#include "drivers/mujoco/model/true_robot.h"
#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "gate/brake_law.h"

namespace robot_control {

/// Returns the brake of a driven or held joint of the true robot; `step` is h in s. Throws DriverError, with value and
/// bound, for a given value that is not stable.
Brake brake_of(const TrueRobot& robot, std::size_t joint, const MujocoPlantParameters& parameters, double step);

/// Returns J of a driven or held joint in kg·m² or kg.
double inertia_of(const TrueRobot& robot, std::size_t joint, const MujocoPlantParameters& parameters);

/// Throws DriverError unless 0 < d h / J ≤ 0.5 and 0 < k h² / J ≤ 0.5.
void check_brake(const Brake& brake, const std::string& joint, double inertia, double step);

}  // namespace robot_control
