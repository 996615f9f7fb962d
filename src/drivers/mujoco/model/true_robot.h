#pragma once
/// true_robot returns the simulated robot. It is the robot of the URDF, without the overrides of the `robot:` block,
/// with the configured errors of the plant.
///
///   radius      (1 + left_radius_error) or (1 + right_radius_error) times the URDF's
///   wheel base  every wheel moved sideways by wheel_base_error · wheel_base / 2, outwards
///   friction    dry, of a wheel's joint: (1 + wheel_friction_error) times the URDF's
///   inertia     of a wheel about its axle: + gear_ratio² · rotor_inertia
///   payload     a point mass, fixed to the base
///   centre of gravity   in the field (errors.h), ahead and to the left of the described one by
///               centre_of_gravity_error · wheel_base, by moving that of the root link
///
/// Effort limits stay as described, because they belong to the drive.

#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// A machine without drive wheels becomes a drive train without wheels. Throws RobotError as read_drive_train does.
DriveTrain true_robot(const MachineModel& described, const MujocoPlantParameters& parameters);

}  // namespace robot_control
