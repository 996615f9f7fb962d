#pragma once
/// Inertias that a body can have, but not this one. With ρ = √(C/m), C the largest principal moment:
///
///   ρ larger than the whole robot  impossible: rigid_bodies.h scales the inertia down
///   ρ larger than the part itself  doubtful: noted, nothing is changed

#include <urdf_model/link.h>

#include <vector>

#include "robot/bodies/rigid_bodies.h"

namespace robot_control {

/// ρ of what <inertial> says, m; 0 without a mass.
double gyration_radius(const urdf::Link& link);

/// m, diagonal of the box about all links and their shapes at the zero pose; infinite for a robot without shapes.
double robot_size(const RigidBodies& robot);

/// Notes a ρ that is larger than the largest extent of the link's own shapes. 1e-3 kg·m² at 10 g, a wheel of 35 mm, is
/// the classic: copied, not computed.
void note_gyration(const urdf::Link& link, const std::vector<Shape>& shapes, std::vector<RobotNote>& notes);

}  // namespace robot_control
