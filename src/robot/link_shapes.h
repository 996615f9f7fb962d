#pragma once
/// The shapes of one link, as contact sees them.

#include <urdf_model/link.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "robot/rigid_bodies.h"

namespace robot_control {

enum class ShapeSource { kCollision, kVisual };

/// In the frame of a body, of which `in_body` is the link's. A mesh gives the corners of its hull, in metres, times
/// `scale`, each factor of which may be negative (mirrored). Shapes without extent are left out and noted.
///
/// Throws RobotError with file and element: negative or infinite sizes, a scale that is no three numbers or has a
/// zero, whatever resolve_resource and mesh_corners refuse.
std::vector<Shape> shapes_of(const urdf::Link& link, ShapeSource which, const Eigen::Isometry3d& in_body,
                             const RobotDescription& description, std::vector<RobotNote>& notes);

}  // namespace robot_control
