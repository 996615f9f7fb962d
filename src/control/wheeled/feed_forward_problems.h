#pragma once
/// Checks whether `feed_forward` is plausible on this robot. A payload or a rotor behind a gear is plausible, but a
/// hundred times the described value would drive the robot by itself.
///
///   mass, yaw_inertia, wheel_inertia    within factors of 3, 3 and 30 of the description
///   wheel_damping, wheel_friction       up to a quarter of the torque limit at the fastest wheel speed, or twice the
///                                       described value

#include <string>
#include <vector>

#include "control/wheeled/drive_controller_parameters.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Returns one message per problem, with value, rule and remedy; empty: none.
std::vector<std::string> feed_forward_problems(const DriveControllerParameters& parameters, const DriveTrain& robot);

}  // namespace robot_control
