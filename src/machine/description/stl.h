#pragma once
/// Reads the bytes of an STL file as the corners of its triangles.

#include <string_view>

#include "machine/description/mesh_faces.h"

namespace robot_control {

/// A binary file is always accepted, because its length identifies it. A text is refused if a facet has another number
/// of vertices than three, or a vertex is not three numbers. It is also refused without `endsolid`.
MeshFaces parse_stl(std::string_view bytes);

}  // namespace robot_control
