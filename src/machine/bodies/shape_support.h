#pragma once
/// Computes how far a shape reaches.

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

/// Returns the reach along the unit vector `u` of the body's axes from the body's origin, m; −∞ for a mesh without
/// points.
double support(const Shape& shape, const Eigen::Vector3d& u);

/// Returns the box about a shape in the root's axes, at the zero pose.
Eigen::AlignedBox3d box_of(const RigidBody& body, const Shape& shape);

}  // namespace robot_control
