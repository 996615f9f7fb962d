#pragma once
/// The check of limits, gains and feed-forward, at start and while driving: are they plausible, stable and damped on
/// this robot at this rate?

#include <string>
#include <vector>

#include "control/drive_controller_parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// One message per problem, with value, rule and remedy; empty: none.
///
///   wheels                a torque limit above 0
///   feed_forward          within plausible factors of the description
///   tracking_bandwidth    at most a tenth of the rate, at least a tenth of what is derived
///   gains                 pid_kp at least a tenth of what is derived; for the wheel lifted, turning, straight, and
///   straight with the robot's mass doubled, as the
///                         set and as the description have it: spectral radius < 1, and in every mode a damping ratio
///                         of at least 0.3 (turning, straight) or 0.2, or nine tenths of what derived gains have
///                         lifted, with the counts of an encoder: torque below 0.3 of the limit, RMS
///                         (quantisation_ripple.h), or 1.2 times that of derived gains
///
/// `parameters` are within their ranges, `period` s is > 0.
std::vector<std::string> control_problems(const DriveControllerParameters& parameters, const RobotModel& described,
                                          double period);

}  // namespace robot_control
