#pragma once
/// The drivers of real machines by name. A new driver is one row of the table in factory.cpp and one word of
/// DriverChoice.

#include <functional>
#include <memory>
#include <vector>

#include "configuration/parameters.h"
#include "drivers/line/can_bus.h"
#include "drivers/driver.h"
#include "gate/brake_law.h"
#include "machine/machine_model.h"

namespace robot_control {

using DriverClock = std::function<CanTime()>;

/// `brakes` are those of the robot's kind (robots/robot.h). `clock` states the present time and is called in each
/// cycle. Throws DriverError, and ParameterError with all problems of the driver's own file.
std::unique_ptr<Driver> make_driver(const Parameters& parameters, const MachineModel& machine,
                                    const std::vector<Brake>& brakes, DriverClock clock);

}  // namespace robot_control
