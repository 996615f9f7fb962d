#pragma once
/// Sorts left and right wheels into pairs on axles.

#include <string>
#include <vector>

#include "machine/wheeled/wheels/drive_wheels.h"

namespace robot_control {

inline constexpr const char* kSetWheels =
    "Set robot.left_wheel_joints: […] and robot.right_wheel_joints: […] to the joints of the drive wheels";
inline constexpr const char* kOneRadius = "Set one radius for all drive wheels in the URDF";

struct PairObjection {
  std::string found;
  std::string fix;  ///< kSetWheels: wheels are missing
};

/// Orders `wheels` as in RunningGear and sets their sides by their position about the middle of the outermost ones.
/// Returns why they make no pairs of one radius (drive_wheels.h), in numbers, and what changes it; empty if they do.
PairObjection sort_into_pairs(const RigidBodies& robot, std::vector<RollingBody>& wheels);

/// Returns for example "joint (x 0.1 m, y 0.2 m, radius 0.05 m)".
std::string described(const RigidBodies& robot, const RollingBody& wheel);

}  // namespace robot_control
