#pragma once
/// Reads the collision or visual shapes of one link.

#include <urdf_model/link.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

enum class ShapeSource { kCollision, kVisual };

/// Returns the shapes in the frame of a body; `in_body` is the link's frame in it. A mesh gives the corners of its
/// hull, in metres, times `scale`; a negative factor mirrors it. Shapes without extent are left out and noted. Points
/// of a mesh that are not finite are noted as suspicious.
///
/// Throws RobotError with file and element for negative or infinite sizes and for a scale that is not three numbers
/// other than zero. It also throws what resolve_resource and mesh_corners refuse. If `missing` is given, a mesh that
/// resolve_resource does not find is left out with a suspicious note. The message of its error is added to `missing`.
std::vector<Shape> shapes_of(const urdf::Link& link, ShapeSource which, const Eigen::Isometry3d& in_body,
                             const RobotDescription& description, std::vector<RobotNote>& notes,
                             std::vector<std::string>* missing = nullptr);

/// Returns the <visual> meshes of the link that resolve_resource does not find, as written in the file.
std::vector<std::string> missing_visuals(const urdf::Link& link, const RobotDescription& description);

}  // namespace robot_control
