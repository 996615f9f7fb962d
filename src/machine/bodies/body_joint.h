#pragma once
/// Reads the motion between two bodies from a `<joint>`.

#include <urdf_model/joint.h>

#include <string>
#include <vector>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

/// A joint that may turn by more than this, in rad, has no end: "±1e16" and similar limits mean continuous.
inline constexpr double kEndless = 4 * 3.14159265358979323846;

/// Reads a joint that is not fixed. A `continuous` joint has no limits, even if the file gives some. A limit of ±180 is
/// noted as degrees. Efforts and velocities that are not above zero are unknown: 0.
///
/// Throws RobotError for an axis without length, for numbers that are not finite and for lower above upper.
BodyJoint read_joint(const urdf::Joint& joint, const std::string& source, std::vector<RobotNote>& notes);

}  // namespace robot_control
