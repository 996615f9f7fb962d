#pragma once
/// Reads the motion between two bodies from a `<joint>`.

#include <urdf_model/joint.h>

#include <string>
#include <vector>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

/// Reads a joint that is not fixed. A `continuous` joint has no limits, even if the file gives some. A revolute one
/// that may turn by more than `endless` rad is taken as continuous. A limit of ±180 is noted as degrees. Efforts and
/// velocities that are not above zero are unknown: 0.
///
/// Throws RobotError for an axis without length, for numbers that are not finite, for lower above upper, and for
/// damping or friction beyond kMaxPlausible.
BodyJoint read_joint(const urdf::Joint& joint, const std::string& source, double endless,
                     std::vector<RobotNote>& notes);

}  // namespace robot_control
