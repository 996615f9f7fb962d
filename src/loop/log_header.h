#pragma once

#include "configuration/parameters.h"
#include "log/messages/log_messages.h"
#include "machine/machine_model.h"

namespace robot_control {

/// The header of a log of this robot with these parameters, on this computer.
LogHeader log_header(const Parameters& parameters, const MachineModel& robot);

}  // namespace robot_control
