#pragma once
/// This type holds the result of a parser of mesh files.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace robot_control {

struct MeshFaces {
  std::vector<Eigen::Vector3d> points;  ///< m, corners of all faces in the order of the file
  std::string problem;                  ///< problem of the file; empty: none
};

}  // namespace robot_control
