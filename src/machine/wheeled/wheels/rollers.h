#pragma once
/// Recognises wheels whose rims are rollers: omni and mecanum wheels.
///
/// A roller's axis is across the wheel's axle (by more than 10°), and its distance from the axle is more than half of
/// the wheel's reach. A fixed cylinder is a roller if it also lies across the radius (by more than 60°, unlike spokes)
/// and reaches the rim within 10 %. A body is such a wheel if it has kMinRollers of them, joints or shapes.

#include <cstddef>
#include <string>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

inline constexpr std::size_t kMinRollers = 4;

inline constexpr const char* kRollersRemedy =
    "Remove the rollers from the URDF to drive it as a differential or skid-steer drive; no other drive is supported";

/// Returns how many rollers the body carries; 0 if they are fewer than kMinRollers.
std::size_t rollers_of(const RigidBodies& robot, std::size_t body);

/// Returns why a wheel with so many rollers is refused.
std::string rollers_objection(std::size_t rollers);

}  // namespace robot_control
