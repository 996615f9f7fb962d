#pragma once
/// A slow loop has its price on wheels. Torques that change once a period must not make a lifted wheel oscillate,
/// so gains and brakes of the drives are proportional to the rate.

#include <string>
#include <vector>

#include "configuration/parameters.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// s, kp/ki of the slowest wheel: the time constant with which a wheel loop corrects what its plan does not contain.
double correction_time(const Parameters& parameters, const DriveTrain& robot);

/// s, of the slowest wheel: J_straight/d, the time constant of the brake (brakes_of_slow_drives) of a robot that drives
/// straight, below the brake's largest torque.
double brake_time(const DriveTrain& robot, double period);

/// Returns the sentences of the node that plays this role. None if the loop is not slow (configuration/rate_notes.h).
std::vector<std::string> wheeled_rate_notes(const Parameters& parameters, const DriveTrain& robot, Role role);

}  // namespace robot_control
