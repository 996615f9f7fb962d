#pragma once
/// Reads OBJ and DAE files through assimp 5.2, whose other readers are not used. It prints nothing.
///
/// It runs in a separate process (other_process.h). Nodes that refer to each other in a circle make assimp overflow its
/// stack. Wrong counts or strides in a file make it access memory outside its arrays.

#include <string>
#include <string_view>

#include "machine/description/mesh_faces.h"

namespace robot_control {

/// Returns the corners of every face with three or more, placed by the nodes' transforms. A problem is reported in
/// assimp's words, or as a crash of assimp. `format` is "obj" or "dae". Only `bytes` is read: no textures, no
/// materials.
MeshFaces parse_with_assimp(std::string_view bytes, const std::string& format);

}  // namespace robot_control
