#pragma once
/// The gate's parameters before a robot on wheels.
///
///   stop actions   of its drive wheels robot.fail_action; every other joint brakes
///   longest ramp   ⌈ramp_time/period⌉ + loss_cycles: the monitor's own deadline, and as long as a loss may last

#include "configuration/parameters.h"
#include "gate/gate_parameters.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

GateParameters gate_parameters(const Parameters& parameters, const DriveTrain& robot);

}  // namespace robot_control
