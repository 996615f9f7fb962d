#pragma once
/// Swivels are upright joints that turn a wheel into another direction.

#include <cstddef>

#include "machine/bodies/rolling.h"

namespace robot_control {

inline constexpr double kMinTrail = 0.05;  ///< share of the wheel's radius

/// Returns true if the body turns about an axis within 37° of the vertical.
bool is_swivel(const RigidBody& body);

/// Returns the body of the nearest swivel between `body` and the root; null: there is none.
const RigidBody* swivel_of(const RigidBodies& robot, std::size_t body);

/// Returns true if the swivel turns the wheel into the direction of travel. The trail is the distance by which the
/// wheel follows the swivel's axis, across the axle. It must be at least kMinTrail of the radius.
bool trails(const RigidBody& swivel, const RollingMeasure& wheel);

/// Returns true for a wheel that does not trail and is turned. Swivel or wheel is driven or follows another joint, or
/// the swivel turns by less than 342°.
bool is_steered(const RigidBody& swivel, const RigidBody& body, const RollingMeasure& wheel);

}  // namespace robot_control
