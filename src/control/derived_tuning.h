#pragma once
/// The user's parameters → the numbers that the controller runs with.
///
/// Parameters that are left out are derived: a deceleration from its acceleration (drive_limits.h), gains and bandwidth
/// from robot and rate (wheel_loop_gains.h), with the measured robot (measured_robot.h). They are derived again
/// whenever another parameter changes.

#include "control/drive_controller_parameters.h"
#include "control/limits/speed_limiter.h"
#include "control/wheel_loops/wheel_loop.h"
#include "robot/robot_model.h"
#include "signals/drive_tuning.h"

namespace robot_control {

/// `robot` as described; at most kMaxWheels wheels. `period` s > 0. Count is 0. Allocates: not for the real-time
/// thread.
DriveTuning drive_tuning(const DriveControllerParameters& parameters, const RobotModel& robot, double period);

SpeedLimits speed_limits(const DriveTuning& tuning) noexcept;

WheelLoopGains wheel_loop_gains(const WheelTuning& tuning) noexcept;

}  // namespace robot_control
