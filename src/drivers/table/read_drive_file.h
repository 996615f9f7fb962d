#pragma once
/// The drive file is YAML: which drive on a CAN bus, or which wheel of a board, moves which joint.
///
///   bus:                # the block of the line (DriveFile::line_block); `dialect` names the drive on a CAN bus
///   every_joint:        # may be left out; values of all joints, which the block of a joint outweighs
///   left_wheel_joint:   # one block per joint of the robot
///     node: 0
///
/// config/drives has one commented example per drive.

#include <memory>
#include <string>
#include <vector>

#include "configuration/parameters.h"
#include "drivers/drive/drive_file.h"

namespace robot_control {

/// `driver` is the word of robot.driver; mujoco stands for the simulated drives of `can`. Throws ParameterError with
/// all problems of the file, also if its line cannot carry the messages.
std::unique_ptr<DriveFile> read_drive_file(const std::string& path, std::string_view driver, DriveFileRequest request);

/// The block of the line alone; the blocks of the joints are not read.
std::unique_ptr<DriveFile> read_drive_line(const std::string& path, std::string_view driver);

/// The same of the drive file, the driver, the rate and the wheel command of these parameters.
std::unique_ptr<DriveFile> read_drive_file(const Parameters& parameters, std::vector<std::string> joints);

}  // namespace robot_control
