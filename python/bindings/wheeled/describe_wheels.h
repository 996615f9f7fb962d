#pragma once
/// The description of a robot on wheels for Python, beyond that of every machine.

#include <pybind11/pybind11.h>

#include "machine/machine_model.h"

namespace robot_control {

/// Adds wheels, casters, wheel base and yaw inertia to `result`. Throws RobotError for a machine without drive wheels.
void describe_wheels(const MachineModel& machine, pybind11::dict& result);

}  // namespace robot_control
