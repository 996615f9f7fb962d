#pragma once
/// Checks at start and while driving whether limits, gains and feed-forward are plausible, stable and damped on this
/// robot at this rate.

#include <string>
#include <vector>

#include "control/wheeled/drive_controller_parameters.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Returns one message per problem, with value, rule and remedy; empty: none. The checks are:
///
///   wheels               the torque limit is above 0
///   feed_forward         it is within plausible factors of the description
///   tracking_bandwidth   it is at most a tenth of the rate and at least a tenth of the derived one
///   gains                pid_kp is at least a tenth of the derived one. With every load, as set and as described, the
///                        loop is stable (spectral radius < 1) and damped: a ratio of at least 0.3 (turning, straight)
///                        or 0.2 (lifted, mass doubled), or nine tenths of that of derived gains. With the counts of an
///                        encoder, the torque of the lifted wheel is below 0.3 of the limit, RMS
///                        (quantisation_ripple.h), or 1.2 times that of derived gains
///
/// The gains are not checked where the drives close the wheel loops (robot.wheel_command): one that is set is a
/// problem.
///
/// `parameters` are within their ranges, and `period` (s) is > 0.
std::vector<std::string> control_problems(const DriveControllerParameters& parameters, const DriveTrain& described,
                                          double period);

}  // namespace robot_control
