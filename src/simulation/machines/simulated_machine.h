#pragma once
/// The simulated machine that the parameters describe is a MuJoCo plant. Its motors are given their torques directly,
/// or they stand behind simulated drives on CAN (Parameters::drives).

#include <memory>
#include <vector>

#include "configuration/parameters.h"
#include "drivers/driver.h"
#include "gate/brake_law.h"
#include "machine/machine_model.h"
#include "simulation/machines/device_simulator.h"

namespace robot_control {

/// `brakes` are those of the robot's kind (robots/robot.h). Throws DriverError, and ParameterError with all problems of
/// the drive file.
std::unique_ptr<Driver> make_simulated_machine(const Parameters& parameters, const MachineModel& machine,
                                               const std::vector<Brake>& brakes);

/// Returns the simulated robot for a driver in another program, which finds it at the address of the drive file. Throws
/// as make_simulated_machine.
std::unique_ptr<DeviceSimulator> make_device_simulator(const Parameters& parameters, const MachineModel& machine,
                                                       const std::vector<Brake>& brakes);

}  // namespace robot_control
