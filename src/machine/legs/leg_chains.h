#pragma once
/// Finds the legs of a machine among the chains of bodies on its root body.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

/// A chain of bodies on the root in which no body carries two others.
struct BodyChain {
  std::vector<std::size_t> bodies;
};

/// Returns the axis of the base that a leg's joint turns about, by its place from the body outwards.
constexpr Eigen::Index leg_axis(std::size_t place) noexcept {
  return place == 0 ? 0 : 1;
}

/// Returns the joint's axis in the base's axes at the zero pose.
Eigen::Vector3d axis_in_base(const RigidBody& body);

/// Returns the chains that begin as a leg: turning joints that are nearer to x, y and y than to other axes. A chain
/// that branches ends there.
std::vector<BodyChain> leg_chains(const RigidBodies& robot);

/// Returns the chains of at least two joints that do not end in a wheel: legs, and what may be meant as a leg.
std::vector<BodyChain> limbs_of(const RigidBodies& robot);

/// Returns true if at least two chains on the root body are legs, or legs with a joint more. It also returns true for
/// four limbs on a machine without wheels. Such a machine is for read_legs to accept or refuse, others are not.
bool has_legs(const RigidBodies& bodies);

/// Throws RobotError if the chains are not four legs, or if anything else moves. If four limbs are almost legs, it
/// names the difference.
void refuse_other_chains(const RigidBodies& robot, const std::vector<BodyChain>& chains);

}  // namespace robot_control
