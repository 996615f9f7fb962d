#pragma once
/// Reads the drive wheels that the `robot:` block names.

#include <vector>

#include "machine/wheeled/wheels/drive_wheels.h"

namespace robot_control {

/// Returns them in the order of RunningGear. Throws RobotError (drive_wheels.h).
std::vector<RollingBody> named_wheels(const RigidBodies& robot, const DriveTrainParameters& parameters);

}  // namespace robot_control
