#pragma once
/// Sorts left and right wheels into pairs on axles.

#include <string>
#include <vector>

#include "machine/wheeled/wheels/drive_wheels.h"

namespace robot_control {

/// Orders `wheels` as in RunningGear and sets their sides by their position about the middle of the outermost ones.
/// Returns why they make no pairs of one radius (drive_wheels.h), in numbers; empty if they do.
std::string sort_into_pairs(const RigidBodies& robot, std::vector<RollingBody>& wheels);

/// Returns for example "joint (x 0.1 m, y 0.2 m, radius 0.05 m)".
std::string described(const RigidBodies& robot, const RollingBody& wheel);

}  // namespace robot_control
