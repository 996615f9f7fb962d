#pragma once
/// Converts the user's parameters to the numbers that the controller runs with.
///
/// Parameters that are left out are derived. A deceleration follows from its acceleration (drive_limits.h). Gains and
/// bandwidth follow from the rate and the measured robot (wheel_loop_gains.h, measured_robot.h). They are derived again
/// whenever another parameter changes.

#include "control/wheeled/drive_controller_parameters.h"
#include "control/wheeled/limits/speed_limiter.h"
#include "control/wheeled/wheel_loops/wheel_loop.h"
#include "machine/wheeled/drive_train.h"
#include "signals/wheeled/drive_tuning.h"

namespace robot_control {

/// `robot` is the described one, with at most kMaxWheels wheels, and `period` (s) is > 0. The count is 0. It allocates
/// and is not for the real-time thread.
DriveTuning drive_tuning(const DriveControllerParameters& parameters, const DriveTrain& robot, double period);

SpeedLimits speed_limits(const DriveTuning& tuning) noexcept;

WheelLoopGains wheel_loop_gains(const WheelTuning& tuning) noexcept;

}  // namespace robot_control
