#pragma once
/// The limits of the robot's controller, within which a LocalController plans.

#include <dynamic_reconfigure/Config.h>

#include "control/legged/leg_controller_parameters.h"
#include "control/wheeled/drive_controller_parameters.h"
#include "navigation/local_controller.h"

namespace robot_control::navigation {

inline constexpr double kMaxLateral = 0.3;  ///< m/s; as teleop.py

/// Return the limits of a controller, within those of follow_path. Both accelerations of an axis are the smaller one of
/// acceleration and deceleration.
DriveLimits limits_of(const DriveControllerParameters& wheels);
DriveLimits limits_of(const LegControllerParameters& legs);

/// Takes over the values of a message of ~parameter_updates. One that its key does not allow is left out.
void take_over(const dynamic_reconfigure::Config& message, DriveControllerParameters& wheels);

}  // namespace robot_control::navigation
