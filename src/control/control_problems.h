#pragma once
/// The start-up check: are these gains stable on this robot at this rate?

#include <string>
#include <vector>

#include "control/drive_controller_parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// One message per problem, with value, rule and remedy; empty: none. Each wheel must have a spectral radius < 1
/// lifted, turning, straight and straight with the robot's mass doubled, and a torque limit above 0.
/// `parameters` within their ranges, `period` s > 0.
std::vector<std::string> control_problems(const DriveControllerParameters& parameters, const RobotModel& robot,
                                          double period);

}  // namespace robot_control
