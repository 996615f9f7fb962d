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
///   tracking_bandwidth    at most a tenth of the rate
///   gains                 for the wheel lifted, turning, straight, and straight with the robot's mass doubled, as the
///                         set and as the description have it: spectral radius < 1, and in every mode a damping ratio
///                         of at least 0.3 (turning, straight) or 0.2, or nine tenths of what derived gains have
///                         lifted, with the counts of an encoder: torque below 0.3 of the limit, RMS
///                         (quantisation_ripple.h), or 1.2 times that of derived gains
///   a set of more than limits    drives a model (rehearsal.h), which takes some ms; where the limits that are in force
///                         are steeper, with them as well: a robot that accelerates takes the set over as it moves
///
/// `parameters` within their ranges, `period` s > 0. `in_force`: of the robot that is to take them over while it
/// drives; null at start.
std::vector<std::string> control_problems(const DriveControllerParameters& parameters, const RobotModel& described,
                                          double period, const DriveControllerParameters* in_force = nullptr);

}  // namespace robot_control
