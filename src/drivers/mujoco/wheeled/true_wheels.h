#pragma once
/// on_true_wheels returns the simulated robot of a machine on wheels (model/true_robot.h).
///
///   radius      (1 + left_radius_error) or (1 + right_radius_error) times the URDF's
///   wheel base  every wheel moved sideways by wheel_base_error · wheel_base / 2, outwards
///   friction    dry, of a wheel's joint: (1 + wheel_friction_error) times the URDF's
///   inertia     of a wheel about its axle: + gear_ratio² · rotor_inertia
///   brake       gate/wheeled/wheel_stop.h, of the robot with all these errors

#include <optional>

#include "drivers/mujoco/model/true_robot.h"

namespace robot_control {

/// Returns nothing for a machine without drive wheels. `step` is the time step of the simulated drives in s. Throws
/// RobotError as read_drive_train does.
std::optional<TrueRobot> on_true_wheels(const MachineModel& described, const MujocoPlantParameters& parameters,
                                        double step);

}  // namespace robot_control
