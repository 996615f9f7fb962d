#pragma once
/// Moving bodies whose links have no <inertial>: rigid_bodies.h says what becomes of them.

#include <set>
#include <string>
#include <vector>

#include "robot/bodies/rigid_bodies.h"

namespace robot_control {

struct LumpedBodies {
  RigidBodies robot;
  std::vector<bool> weighed;  ///< per body: one of its links has an <inertial>
};

/// The joints of those that nothing which rolls depends on.
std::set<std::string> idle_massless_joints(const LumpedBodies& lumped);

/// Gives the others their share of the parent's mass; the sum stays. Throws RobotError: a base without mass on
/// which something moves, a moving body whose <mass> is zero.
void lend_mass(LumpedBodies& lumped);

}  // namespace robot_control
