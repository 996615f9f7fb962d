#pragma once
/// What a `<joint>` says of the motion between two bodies.

#include <urdf_model/joint.h>

#include <string>
#include <vector>

#include "robot/bodies/rigid_bodies.h"

namespace robot_control {

/// A joint that may turn by more than this has no end: "±1e16" and the like stand for continuous.
inline constexpr double kEndless = 4 * 3.14159265358979323846;

/// Fixed joints are the caller's. A `continuous` joint has no limits, whatever it says; ±180 is noted as degrees.
/// Efforts and velocities that are not above zero are unknown: 0.
///
/// Throws RobotError: an axis without length, numbers that are not finite, lower above upper.
BodyJoint read_joint(const urdf::Joint& joint, const std::string& source, std::vector<RobotNote>& notes);

}  // namespace robot_control
