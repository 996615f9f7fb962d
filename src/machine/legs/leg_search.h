#pragma once
/// Finds the chains of joints that are legs.

#include <cstddef>
#include <vector>

#include "machine/bodies/rigid_bodies.h"
#include "machine/legs/leg_kinematics.h"

namespace robot_control {

/// A chain of bodies on the root in which no body carries two others.
struct BodyChain {
  std::vector<std::size_t> bodies;
};

/// Returns the chains that begin as a leg: turning joints that are nearer to x, y and y than to other axes. A chain
/// that branches ends there.
std::vector<BodyChain> leg_chains(const RigidBodies& robot);

/// Returns the axis of the base that a leg's joint turns about, by its place from the body outwards.
inline Eigen::Index leg_axis(std::size_t place) noexcept {
  return place == 0 ? 0 : 1;
}

/// Returns the joint's axis in the base's axes at the zero pose.
Eigen::Vector3d axis_in_base(const RigidBody& body);

struct Foot {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, base axes at the zero pose
  double radius = 0;                                 ///< m; 0: no ball
};

/// Returns the foot at the end of the leg whose last body is `body`. Throws RobotError if it has no shape.
Foot foot_of(const RigidBodies& robot, const RigidBody& body);

}  // namespace robot_control
