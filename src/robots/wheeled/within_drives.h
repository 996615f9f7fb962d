#pragma once
/// The limits of the drives are limits of the robot. The model has them, and through it plan, gate and monitor.

#include "configuration/parameters.h"
#include "machine/machine_model.h"

namespace robot_control {

/// Returns the parameters with the smallest limits of the wheels and of the drives in the drive file. They are
/// robot.wheel_velocity_limit, wheel_effort_limit and wheel_effort_rate. Each limit that was lowered has a warning.
/// Throws ParameterError and RobotError as read_drive_file and read_drive_train.
Parameters within_drives(Parameters parameters, const RobotDescription& description);

}  // namespace robot_control
