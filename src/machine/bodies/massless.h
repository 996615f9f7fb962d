#pragma once
/// Gives mass to moving bodies whose links have no <inertial>, by the rule of rigid_bodies.h.

#include <set>
#include <string>
#include <vector>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

struct LumpedBodies {
  RigidBodies robot;
  std::vector<bool> weighed;  ///< per body: one of its links has an <inertial>
};

/// Returns the joints of massless bodies that carry nothing which rolls.
std::set<std::string> idle_massless_joints(const LumpedBodies& lumped);

/// Gives the other massless bodies their share of the parent's mass; the sum stays. Throws RobotError if a base without
/// mass carries something that moves, or if the <mass> of a moving body is zero.
void assign_massless_inertia(LumpedBodies& lumped);

}  // namespace robot_control
