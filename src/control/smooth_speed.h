#pragma once
/// The speed below which wheels start with a jerk, because their encoders have few counts.
///
/// A wheel that is held by more than feed-forward knows of friction, ground and load begins to turn when the integrator
/// has found the rest. It is seen to turn after a count q at most, and treads that scrub first give by kTread. Until
/// then its torque goes on rising by ki·v, v the planned speed. With the inertia J, the smaller one of straight_inertia
/// and turning_inertia, it has turned by q after t, and reached ω:
///
///   q = ki·v·t³/(6·J)     ω = ki·v·t²/(2·J) = 3·q/t
///
/// ω is no more than v from
///
///   v = √(27/6)·q·√(ki/J)
///
/// on, with q + kTread in place of q for treads that scrub. No gains help: for half of ω the torque has to rise at an
/// eighth of the pace, and the wheel begins to turn eight times as late. Measured: docs/evidence/drive.md.

#include "control/drive_controller_parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// rad of a wheel, over which the torque of its tread builds up (scrub.h).
inline constexpr double kTread = 0.005;

/// m/s of a rim, v of the wheel with the largest one. `quantum` q, rad; `period` s > 0. 0 without an integrator.
double smooth_speed(const DriveControllerParameters& parameters, const RobotModel& robot, double quantum,
                    double period);

}  // namespace robot_control
