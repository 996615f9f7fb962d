#pragma once
/// OBJ and DAE through assimp 5.2, the only two of its readers that are used. It prints nothing.

#include <string>
#include <string_view>

#include "robot/mesh_faces.h"

namespace robot_control {

/// The corners of every face with three or more, where the nodes' transforms put them. A problem is told in assimp's
/// words. `format`: "obj" or "dae". Nothing but `bytes` is read: no textures, no materials.
MeshFaces parse_with_assimp(std::string_view bytes, const std::string& format);

}  // namespace robot_control
