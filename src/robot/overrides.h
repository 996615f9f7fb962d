#pragma once
/// What the `robot:` block sets differently from the URDF.

#include <optional>
#include <string>
#include <vector>

#include "robot/bodies/rigid_bodies.h"

namespace robot_control {

inline constexpr double kWorthNoting = 0.01;

/// `given` where there is one, else `from_urdf`. A difference above 1 % is noted, once for equal words. Throws
/// RobotError: a value that is not finite or not above zero.
double overridden(const std::string& name, const std::string& unit, const std::optional<double>& given,
                  double from_urdf, const RigidBodies& robot, std::vector<RobotNote>& notes);

}  // namespace robot_control
