#pragma once
/// Refuses machines that look like a differential drive and are none.
///
/// The checks apply to all wheels on the floor beside the drive wheels. A machine that is refused is noted instead if
/// the user named the drive wheels.
///   steered     (swivel.h) refused; if noted, it slides without friction
///   crosswise   refused: a wheel, no ball, with a level axle more than 5° off the lateral one that drives: the file
///               says so, or drives no wheel at all and this one has the drive wheels' radius within 10 %
///   driven      a wheel that the file drives and that is no drive wheel: refused on the middle line, as in a tricycle;
///               else noted
///   rollers     (rollers.h) refused if the file drives the wheel, or drives none at all and the height of this wheel
///               is that of the drive wheels within 10 % of their radius
/// A drive wheel whose joint or link is called mecanum or omni is refused, unless the user named the wheels. It is
/// accepted if the robot or its root is called so, too. Plugins whose names mean sideways motion or steering are noted.
/// One note lists other names of the drive that contain mecanum, omni or holonomic (sideways_names.h).

#include <vector>

#include "machine/wheeled/wheels/drive_wheels.h"

namespace robot_control {

/// Throws RobotError as above. `named` states that the user named the drive wheels.
void judge_other_drives(const RigidBodies& robot, const RunningGear& gear, bool named, std::vector<RobotNote>& notes);

}  // namespace robot_control
