#pragma once
/// The parameters of the controller on wheels that are in force, for whoever plans within its limits.

#include <dynamic_reconfigure/Config.h>

#include "control/wheeled/drive_controller_parameters.h"

namespace robot_control::navigation {

/// Takes over the values of a message of ~parameter_updates. One that its key does not allow is left out.
void take_over(const dynamic_reconfigure::Config& message, DriveControllerParameters& wheels);

}  // namespace robot_control::navigation
