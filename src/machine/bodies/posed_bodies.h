#pragma once
/// Moves the joints of lumped bodies.

#include <map>
#include <span>
#include <string>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

/// Returns the bodies with `in_root` for joints at these positions (rad or m, by name) instead of at the zero pose.
/// Joints that are not named stay at zero. Notes and names stay.
RigidBodies posed(const RigidBodies& bodies, const std::map<std::string, double>& positions);

/// Returns the bodies where they are while each joint is at its JointModel::rest_position.
RigidBodies resting(const RigidBodies& bodies, std::span<const JointModel> joints);

}  // namespace robot_control
