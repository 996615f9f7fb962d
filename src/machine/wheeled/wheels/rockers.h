#pragma once
/// Finds rockers: arms that each carry the wheels of one side and pitch about a lateral axis. Such machines have a
/// differential, a bar or a gear that turns one rocker down when the other goes up. It keeps the chassis at the mean of
/// both. A URDF often leaves it out, and its chassis would tip until it meets the joints' stops.
///
/// A differential is assumed if exactly two such joints hang on one body and have no <mimic>. One must be above all
/// left and one above all right drive wheels, at least two each. The right joint follows the left one with the opposite
/// sign in base axes.

#include <vector>

#include "machine/wheeled/wheels/drive_wheels.h"

namespace robot_control {

/// Sets the follower's BodyJoint::mimicked and notes it.
void assume_differential(RigidBodies& robot, const RunningGear& gear, std::vector<RobotNote>& notes);

}  // namespace robot_control
