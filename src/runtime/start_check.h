#pragma once
/// What parameters and robot must be together, checked by every composition of the loop before it starts.

#include "parameters/parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// Throws ParameterError with every problem: whatever control_problems.h refuses.
void require_drivable(const Parameters& parameters, const RobotModel& robot);

/// The robot with rate and clock in its hash and source: what the driver announces and every other node compares
/// with its own. A node of another rate or clock refuses as one of another robot does.
RobotModel identified(const RobotModel& robot, const LoopParameters& loop);

}  // namespace robot_control
