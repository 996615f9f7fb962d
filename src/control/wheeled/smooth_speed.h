#pragma once
/// Computes the speed below which wheels start with a jerk, because their encoders have few counts.
///
/// A wheel can be held by more friction, ground and load than feed-forward contains. It begins to turn when the
/// integrator has found the rest. The turn is seen after one count q at most; treads that scrub first give by kTread.
/// Until then the torque rises by ki·v, where v is the planned speed. Let J be the smaller one of straight_inertia and
/// turning_inertia. After the time t the wheel has turned by q and reached ω:
///
///   q = ki·v·t³/(6·J)     ω = ki·v·t²/(2·J) = 3·q/t
///
/// ω does not exceed v from this speed on, with q + kTread in place of q for treads that scrub:
///
///   v = √(27/6)·q·√(ki/J)
///
/// No gains help. Half of ω takes an eighth of the pace of the torque. Then the wheel would begin to turn eight times
/// as late. Measured values are in docs/evidence/drive.md.

#include "control/wheeled/drive_controller_parameters.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// The torque of a wheel's tread builds up over this angle of the wheel, in rad (scrub.h).
inline constexpr double kTread = 0.005;

/// Returns v of the wheel with the largest one, in m/s of a rim; 0 without an integrator. `quantum` is q in rad, and
/// `period` (s) is > 0.
double smooth_speed(const DriveControllerParameters& parameters, const DriveTrain& robot, double quantum,
                    double period);

}  // namespace robot_control
