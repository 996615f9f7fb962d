#pragma once
/// The motors behind the drives of a machine. There is one for each driven joint, in the order of the joints.

#include <cstddef>
#include <string>
#include <vector>

#include "gate/brake_law.h"
#include "machine/machine_model.h"

namespace robot_control {

struct DriveMotors {
  std::vector<std::string> joints;    ///< names
  std::vector<double> effort_limits;  ///< N·m, of the drives
  std::vector<Brake> brakes;          ///< of drives that are given a torque once in each period
  std::size_t joint_count = 0;        ///< of the machine, the joints that are not driven included
};

/// `brakes` are those of the robot's kind, one for each driven joint, which are the first ones of the machine. Throws
/// DriverError if there are none: drives that only take torques then do not stop this robot.
DriveMotors drive_motors(const MachineModel& machine, const std::vector<Brake>& brakes);

}  // namespace robot_control
