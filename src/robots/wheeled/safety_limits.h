#pragma once
/// The monitor's limits in every composition of the loop. Limits that the user left out follow from the robot and from
/// the speed limits of its controller.

#include "configuration/parameters.h"
#include "machine/wheeled/drive_train.h"
#include "safety/safety_parameters.h"

namespace robot_control {

/// rad/s, the fastest that the controller's limits ask of any wheel:
///
///   max over wheels of (max_linear_speed + max_angular_speed·b/2)/radius,   b the effective wheel base
///
/// and no more than the slowest wheel's velocity limit; the controller scales its command to kUsableWheelSpeed of that
/// (control/wheeled/kinematics.h).
double commanded_wheel_speed(const DriveControllerParameters& controller, const DriveTrain& robot);

/// N·m/rad: RMS of the torque that the derived gains of control/wheeled/wheel_loops/wheel_loop_gains.h make of encoder
/// counts, by the size q of a count. A step by q moves the tracked speed by up to 0.8·w·q, w = 2π·bandwidth (the
/// critically damped third-order loop of machine/encoders/tracking_loop.h); over a turn that is an RMS of at most
/// 0.5·w·q, times kp.
double count_ripple(const DriveTrain& robot, const WheelModel& wheel, double period);

/// encoders_lost has no shorter persistence than the driver tolerates (drivers/table/drive_table.h) (docs/drivers.md).
SafetyParameters safety_limits(const Parameters& parameters, const DriveTrain& robot);

}  // namespace robot_control
