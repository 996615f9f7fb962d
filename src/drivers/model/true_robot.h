#pragma once
/// The robot that is simulated: what its URDF says, not what the `robot:` block believes, with the errors the plant
/// was told to have.
///
///   radius      (1 + left_radius_error) or (1 + right_radius_error) times the URDF's
///   wheel base  every wheel moved sideways by wheel_base_error · wheel_base / 2, outwards
///   inertia     of a wheel about its axle: + gear_ratio² · rotor_inertia
///   payload     a point mass, fixed to the base
///
/// Effort limits are the believed ones: they belong to the drive.

#include "drivers/mujoco_plant_parameters.h"
#include "robot/bodies/rigid_bodies.h"
#include "robot/robot_model.h"

namespace robot_control {

/// Throws RobotError as read_robot does, which it calls.
RobotModel true_robot(const RobotModel& believed, const MujocoPlantParameters& parameters);

}  // namespace robot_control
