#pragma once
/// OBJ and DAE through assimp 5.2, the only two of its readers that are used. It prints nothing.
///
/// It runs in a process of its own (other_process.h): nodes that stand for each other in a circle and counts or strides
/// that the file does not hold to lead it out of its stack and out of its arrays.

#include <string>
#include <string_view>

#include "description/mesh_faces.h"

namespace robot_control {

/// The corners of every face with three or more, where the nodes' transforms put them. A problem is reported in
/// assimp's words, or that it breaks down. `format`: "obj" or "dae". Nothing but `bytes` is read: no textures, no
/// materials.
MeshFaces parse_with_assimp(std::string_view bytes, const std::string& format);

}  // namespace robot_control
