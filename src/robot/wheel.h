#pragma once
/// A wheel as its URDF describes it: a body on a lateral axle with a round collision shape.

#include <string>

#include "robot/rigid_bodies.h"

namespace robot_control {

/// An axle deviates from the lateral axis by less than this, and so does a shape from its axle: 0.2°.
inline constexpr double kAxleTolerance = 0.2 * 3.14159265358979323846 / 180;

/// Centre, radius, width: of the largest cylinder or sphere among the body's shapes (a sphere is as wide as it is
/// high). sign: +1 where the axis points left. inertia: aᵀ I a + m |d⊥|², a the axle, d⊥ the centre of gravity's
/// distance from it. `joint` is left to the caller.
///
/// Throws RobotError: no such joint, fixed or sliding, axle not lateral, no round shape, shape not around the axle,
/// no effort or velocity limit.
WheelModel measure_wheel(const RigidBodies& robot, const std::string& joint);

/// The shape of `body` that rolls; null when it has none.
const Shape* rolling_shape(const RigidBody& body);

}  // namespace robot_control
