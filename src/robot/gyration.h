#pragma once
/// Inertias that a body can have, but hardly this one.

#include <urdf_model/link.h>

#include <vector>

#include "robot/rigid_bodies.h"

namespace robot_control {

/// Notes a radius of gyration √(C/m), C the largest principal moment, that is larger than the largest extent of the
/// link's own shapes; nothing is changed. 1e-3 kg·m² at 10 g, a wheel of 35 mm, is the classic: copied, not computed.
void note_gyration(const urdf::Link& link, const std::vector<Shape>& shapes, std::vector<RobotNote>& notes);

}  // namespace robot_control
