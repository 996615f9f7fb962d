#pragma once

#include "configuration/parameters.h"
#include "log/messages/log_messages.h"
#include "robots/robot.h"

namespace robot_control {

/// The header of a log of this robot with these parameters, on this computer.
LogHeader log_header(const Parameters& parameters, const Robot& robot);

}  // namespace robot_control
