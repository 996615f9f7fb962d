#pragma once
/// Finds inertias that a body can have, but not this one. The radius of gyration is ρ = √(C/m) with the largest
/// principal moment C:
///
///   ρ larger than the whole robot  impossible: rigid_bodies.h scales the inertia down
///   ρ larger than the part itself  doubtful: noted, nothing is changed

#include <urdf_model/link.h>

#include <vector>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

/// Returns ρ of the <inertial>, m; 0 without a mass.
double gyration_radius(const urdf::Link& link);

/// Returns the diagonal of the box about all links and their shapes at the zero pose, m; infinite for a robot without
/// shapes.
double robot_size(const RigidBodies& robot);

/// Notes a ρ that is larger than the largest extent of the link's own shapes. A common case is a copied 1e-3 kg·m² on a
/// wheel of 10 g and 35 mm.
void note_gyration(const urdf::Link& link, const std::vector<Shape>& shapes, std::vector<RobotNote>& notes);

}  // namespace robot_control
