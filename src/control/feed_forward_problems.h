#pragma once
/// Is `feed_forward` plausible on this robot? A payload, a rotor behind a gear: but not a hundred times what is
/// described, which would drive the robot by itself.
///
///   mass, yaw_inertia, wheel_inertia    within 3, 3 and 30 times of the description, either way
///   wheel_damping, wheel_friction       a quarter of the torque limit at the fastest wheel speed, or twice the
///   described

#include <string>
#include <vector>

#include "control/drive_controller_parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// One message per problem, with value, rule and remedy; empty: none.
std::vector<std::string> feed_forward_problems(const DriveControllerParameters& parameters, const RobotModel& robot);

}  // namespace robot_control
