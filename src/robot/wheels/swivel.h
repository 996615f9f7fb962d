#pragma once
/// Upright joints that turn a wheel into another direction.

#include <cstddef>

#include "robot/wheels/wheel.h"

namespace robot_control {

inline constexpr double kLeastTrail = 0.05;  ///< of the wheel's radius

/// It turns about an axis within 37° of the vertical.
bool is_swivel(const RigidBody& body);

/// The nearest joint between `body` and the root that is a swivel, by the body it moves; null: there is none.
const RigidBody* swivel_of(const RigidBodies& robot, std::size_t body);

/// A caster's swivel turns it into the direction of travel by its trail, the distance by which the wheel follows the
/// swivel's axis, across the axle: at least kLeastTrail of the radius.
bool trails(const RigidBody& swivel, const RollingMeasure& wheel);

/// A wheel that does not trail and that something turns: swivel or wheel is driven or follows another joint, or the
/// swivel turns only so far (by less than 342°).
bool is_steered(const RigidBody& swivel, const RigidBody& body, const RollingMeasure& wheel);

}  // namespace robot_control
