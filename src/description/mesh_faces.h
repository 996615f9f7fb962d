#pragma once
/// What the parsers of mesh files give.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace robot_control {

struct MeshFaces {
  std::vector<Eigen::Vector3d> points;  ///< m; the corners of all faces, in the order of the file
  std::string problem;                  ///< what is wrong with the file; empty: nothing
};

}  // namespace robot_control
