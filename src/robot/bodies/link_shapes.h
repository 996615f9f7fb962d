#pragma once
/// The shapes of one link, as contact sees them.

#include <urdf_model/link.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "robot/bodies/rigid_bodies.h"

namespace robot_control {

enum class ShapeSource { kCollision, kVisual };

/// In the frame of a body, of which `in_body` is the link's. A mesh gives the corners of its hull, in metres, times
/// `scale`, each factor of which may be negative (mirrored). Shapes without extent are left out and noted.
///
/// Throws RobotError with file and element: negative or infinite sizes, a scale that is no three numbers or has a
/// zero, whatever resolve_resource and mesh_corners refuse. Where `missing` is given, a mesh that resolve_resource does
/// not find is left out with a suspicious note, and the message that would have refused it goes there. Points of a mesh
/// that are not finite are noted as suspicious.
std::vector<Shape> shapes_of(const urdf::Link& link, ShapeSource which, const Eigen::Isometry3d& in_body,
                             const RobotDescription& description, std::vector<RobotNote>& notes,
                             std::vector<std::string>* missing = nullptr);

/// The <visual> meshes of the link that resolve_resource does not find, as they stand in the file.
std::vector<std::string> missing_visuals(const urdf::Link& link, const RobotDescription& description);

}  // namespace robot_control
