#pragma once
/// The drivers of real machines.

#include <memory>
#include <vector>

#include "configuration/parameters.h"
#include "drivers/drive/drive_file.h"
#include "gate/brake_law.h"
#include "machine/machine_model.h"

namespace robot_control {

/// `brakes` are those of the robot's kind (robots/robot.h). `clock` states the present time and is called in each
/// cycle. Throws DriverError, and ParameterError with all problems of the drive file.
std::unique_ptr<Driver> make_driver(const Parameters& parameters, const MachineModel& machine,
                                    const std::vector<Brake>& brakes, const DriverClock& clock);

}  // namespace robot_control
