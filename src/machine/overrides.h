#pragma once
/// Replaces values of the URDF by those of the `robot:` block.

#include <optional>
#include <string>
#include <vector>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

inline constexpr double kNotedShare = 0.01;

/// Returns `given` if it is set, else `from_urdf`. A difference above 1 % is noted, once for equal words. Throws
/// RobotError if the value is not finite or not above zero.
double overridden(const std::string& name, const std::string& unit, const std::optional<double>& given,
                  double from_urdf, const RigidBodies& robot, std::vector<RobotNote>& notes);

}  // namespace robot_control
