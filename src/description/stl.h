#pragma once
/// The bytes of an STL file as the corners of its triangles.

#include <string_view>

#include "description/mesh_faces.h"

namespace robot_control {

/// Refused is of binary files nothing, for their length is what makes them so; of texts a facet with another number of
/// vertices than three, a vertex that is no three numbers, a missing `endsolid`.
MeshFaces parse_stl(std::string_view bytes);

}  // namespace robot_control
