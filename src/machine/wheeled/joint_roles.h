#pragma once
/// Determines the roles of the joints that are not drive wheels.
///
///   kPassive  wheels of casters and the swivels above them, suspensions and rockers (all joints between the root and a
///             wheel), followers of a <mimic>, joints without an effort limit
///   kHeld     the others: arms, lifts, grippers

#include <vector>

#include "machine/wheeled/wheels/drive_wheels.h"

namespace robot_control {

/// Returns one role per body; that of the root has no meaning.
std::vector<JointRole> joint_roles(const RigidBodies& robot, const RunningGear& gear);

}  // namespace robot_control
