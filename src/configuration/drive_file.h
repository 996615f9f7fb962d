#pragma once
/// The drive file is YAML: which drive on a CAN bus moves which joint.
///
///   bus:                # CanBusParameters; dialect: odrive | cia402
///   every_joint:        # may be left out; values of all joints, which the block of a joint outweighs
///   left_wheel_joint:   # one block per joint of the robot: OdriveParameters or Cia402Parameters
///     node: 0
///
/// config/drives has one commented example per dialect.

#include <span>
#include <string>

#include "drivers/can/can_parameters.h"

namespace robot_control {

/// `joints` are the names of the robot's joints that have a motor, `rate` is the loop's in Hz. Throws ParameterError
/// with all problems of the file, also if the planned frames overload the bus.
CanParameters read_drive_file(const std::string& path, std::span<const std::string> joints, double rate);

}  // namespace robot_control
