#pragma once
/// What a user set → the numbers that the controller runs with.
///
/// What is left out follows from what is given: a deceleration from its acceleration (drive_limits.h), gains and
/// bandwidth from robot and rate (wheel_loop_gains.h), with the robot as it was measured (measured_robot.h). So what
/// was left derived stays derived when something else changes.

#include "control/drive_controller_parameters.h"
#include "control/limits/speed_limiter.h"
#include "control/wheel_loops/wheel_loop.h"
#include "robot/robot_model.h"
#include "signals/drive_tuning.h"

namespace robot_control {

/// `robot` as it was read; at most kMaxWheels wheels. `period` s > 0. Count 0. Allocates: for ordinary threads.
DriveTuning drive_tuning(const DriveControllerParameters& parameters, const RobotModel& robot, double period);

SpeedLimits speed_limits(const DriveTuning& tuning) noexcept;

WheelLoopGains wheel_loop_gains(const WheelTuning& tuning) noexcept;

}  // namespace robot_control
