#pragma once
/// The roles of the joints that are not drive wheels.
///
///   kPassive  wheels of casters and the swivels above them, suspensions and rockers (what stands between the root and
///             a wheel), followers of a <mimic>, joints without an effort limit
///   kHeld     the others: arms, lifts, grippers

#include <cstddef>
#include <vector>

#include "robot/wheels/drive_wheels.h"

namespace robot_control {

/// One per body; the root's means nothing.
std::vector<JointRole> joint_roles(const RigidBodies& robot, const DriveTrain& train);

}  // namespace robot_control
