#pragma once
/// Wheels whose rims are rollers: omni and mecanum wheels.
///
/// A roller turns, or as a cylinder lies, across the axle (by more than 10°) and stands beside it by more than half of
/// what the wheel reaches; as a fixed cylinder it also lies across the radius (by more than 60°, where spokes do not)
/// and reaches the rim within 10 %. kLeastRollers of them make such a wheel, whether they are joints or shapes.

#include <cstddef>
#include <string>

#include "robot/bodies/rigid_bodies.h"

namespace robot_control {

inline constexpr std::size_t kLeastRollers = 4;

inline constexpr const char* kRollersRemedy =
    "Only differential and skid-steer drives are supported; to drive it as one all the same, leave the rollers out of "
    "the URDF";

/// How many rollers the body carries; 0 where they are fewer than kLeastRollers.
std::size_t rollers_of(const RigidBodies& robot, std::size_t body);

/// Why a wheel with so many is none.
std::string rollers_objection(std::size_t rollers);

}  // namespace robot_control
