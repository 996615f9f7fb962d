#pragma once
/// The parsers of mesh files give the corners of all faces.

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace robot_control {

struct MeshFaces {
  std::vector<Eigen::Vector3d> points;  ///< m, corners of all faces in the order of the file
  std::string problem;                  ///< problem of the file; empty: none
};

/// A binary STL is always accepted, because its length identifies it. A text is refused if a facet has another number
/// of vertices than three, or a vertex is not three numbers. It is also refused without `endsolid`.
MeshFaces parse_stl(std::string_view bytes);

/// Reads OBJ and DAE through assimp 5.2, whose other readers are not used. It prints nothing.
///
/// The result is the corners of every face with three or more, placed by the nodes' transforms. A problem is reported
/// in assimp's words, or as a crash of assimp. `format` is "obj" or "dae". Only `bytes` is read: no textures, no
/// materials.
///
/// Assimp runs in a separate process (other_process.h). Nodes that refer to each other in a circle make it overflow its
/// stack. Wrong counts or strides in a file make it access memory outside its arrays.
MeshFaces parse_with_assimp(std::string_view bytes, const std::string& format);

}  // namespace robot_control
