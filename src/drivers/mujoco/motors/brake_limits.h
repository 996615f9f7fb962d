#pragma once
/// The brake of a simulated wheel: the kind's own (gate/wheeled/wheel_stop.h) for the true robot, with the values that
/// the user sets instead.

#include <string>

#include "drivers/joint_law.h"
#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "gate/brake_law.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Returns the brake of a wheel of the true robot; `step` is h in s. Throws DriverError, with value and bound, for a
/// given value that is not stable.
Brake brake_of(const DriveTrain& robot, std::size_t wheel, const MujocoPlantParameters& parameters, double step);

/// Throws DriverError unless 0 < d h / J ≤ 0.5 and 0 < k h² / J ≤ 0.5.
void check_brake(const Brake& brake, const std::string& joint, double inertia, double step);

}  // namespace robot_control
