#pragma once
/// Gravity's load on a joint.

#include <cstddef>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

/// Returns true if bodies[`body`] is `carrier` or is carried by it.
bool is_carried(const RigidBodies& bodies, std::size_t body, std::size_t carrier);

/// Returns the effort that holds what the joint of bodies[`body`] carries, in N·m or N, never below zero. The root
/// stands level.
double gravity_load(const RigidBodies& bodies, std::size_t body);

}  // namespace robot_control
