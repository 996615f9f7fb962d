#pragma once

#include "parameters/parameters.h"
#include "recording/log_messages.h"
#include "robot/robot_model.h"

namespace robot_control {

/// What a log of this robot with these parameters, on this computer, begins with.
LogHeader log_header(const Parameters& parameters, const RobotModel& robot);

}  // namespace robot_control
