#pragma once
/// Machines that look like a differential drive and are none.
///
/// Of all that rolls on the floor beside the drive wheels:
///   steered     (swivel.h) refused, unless the user named the drive wheels: then noted, it slides without friction
///   crosswise   a wheel, no ball, that turns about a level axle more than 5° off the lateral one and that drives:
///               the file says so, or names no drive at all and the wheel has the drive wheels' radius within 10 %;
///               likewise
///   driven      that the file drives, and that is none of the drive wheels: on the middle line refused, as a tricycle
///               has it, where the user named no wheels; else noted
///   rollers     (rollers.h) refused where the file drives the wheel, or names no drive at all and the wheel stands as
///               high above the floor as the drive wheels do, within 10 % of their radius; likewise
/// A drive wheel whose joint or link is called mecanum or omni, where the robot and its root are not, is refused where
/// the user named no wheels. What moves the robot sideways or steers it, by the names of its plugins, is noted; so are
/// other names of the drive that say mecanum, omni or holonomic (sideways_names.h), all in one note.

#include <vector>

#include "robot/wheels/drive_wheels.h"

namespace robot_control {

/// Throws RobotError as above. `named`: the user named the drive wheels.
void judge_other_drives(const RigidBodies& robot, const DriveTrain& train, bool named, std::vector<RobotNote>& notes);

}  // namespace robot_control
