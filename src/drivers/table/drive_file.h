#pragma once
/// The drive file is YAML: which drive on a CAN bus, or which wheel of a board, moves which joint.
///
///   bus:                # CanBusParameters; dialect: odrive | cia402 | vesc
///   every_joint:        # may be left out; values of all joints, which the block of a joint outweighs
///   left_wheel_joint:   # one block per joint of the robot: OdriveParameters, Cia402Parameters or VescParameters
///     node: 0
///
/// config/drives has one commented example per dialect.

#include <span>
#include <string>

#include "configuration/parameters.h"
#include "drivers/drive/can_parameters.h"
#include "drivers/board/board_parameters.h"
#include "drivers/roboclaw/roboclaw_parameters.h"

namespace robot_control {

/// `joints` are the names of the robot's joints that have a motor, `rate` is the loop's in Hz. `takes_speeds`: the
/// drives close the loops of their own speeds (robot.wheel_command). Throws ParameterError
/// with all problems of the file, also if the planned frames overload the bus.
CanParameters read_drive_file(const std::string& path, std::span<const std::string> joints, double rate,
                              bool takes_speeds = false);

/// The same of a board on a serial line: a block `board` (BoardLineParameters) and one per joint
/// (BoardWheelParameters).
BoardParameters read_board_file(const std::string& path, std::span<const std::string> joints, double rate,
                                bool takes_speeds = false);

/// The same of the drive file, the rate and the wheel command of these parameters.
CanParameters read_drive_file(const Parameters& parameters, std::span<const std::string> joints);
BoardParameters read_board_file(const Parameters& parameters, std::span<const std::string> joints);
RoboclawParameters read_roboclaw_file(const Parameters& parameters, std::span<const std::string> joints);

}  // namespace robot_control
