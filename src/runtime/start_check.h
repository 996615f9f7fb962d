#pragma once
/// What parameters and robot must be together, checked by every composition of the loop before it starts.

#include "parameters/parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// Throws ParameterError with every problem: a wheel loop that would be unstable on this robot at this rate, a
/// driven joint without torque.
void require_drivable(const Parameters& parameters, const RobotModel& robot);

}  // namespace robot_control
