#pragma once
/// The monitor's limits as every composition of the loop runs with them: what the user gave, the rest from the robot
/// and from how fast its controller may drive it.

#include "parameters/parameters.h"
#include "robot/robot_model.h"
#include "safety/safety_parameters.h"

namespace robot_control {

/// rad/s, the fastest that the controller's limits ask of any wheel:
///
///   max over wheels of (max_linear_speed + max_angular_speed·b/2)/radius,   b the effective wheel base
///
/// and no more than the slowest wheel's velocity limit; the controller scales its command to kUsableWheelSpeed of that
/// (control/kinematics.h).
double commanded_wheel_speed(const DriveControllerParameters& controller, const RobotModel& robot);

SafetyParameters safety_limits(const Parameters& parameters, const RobotModel& robot);

}  // namespace robot_control
