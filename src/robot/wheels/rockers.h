#pragma once
/// Rockers: arms that carry the wheels of one side each and pitch about a lateral axis. Such machines have a
/// differential between the two, a bar or a gear that turns one down when the other goes up, which keeps the chassis
/// at the mean of both. A URDF often leaves it out, and its chassis would tip until it meets the joints' stops.
///
/// Assumed where exactly two such joints hang on one body, each above two or more drive wheels, one above all the left
/// ones and one above all the right ones, and neither has a <mimic> of its own: the right one follows the left one the
/// other way round in base axes.

#include <vector>

#include "robot/wheels/drive_wheels.h"

namespace robot_control {

/// Sets the follower's BodyJoint::mimicked and notes it.
void assume_differential(RigidBodies& robot, const DriveTrain& train, std::vector<RobotNote>& notes);

}  // namespace robot_control
