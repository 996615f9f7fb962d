#pragma once
/// A PoseGraph holds the poses at which scans of the map were made, and measurements between them.
///
/// `optimise` finds the poses that minimise Σ ρ(eᵀ Σ⁻¹ e), with the error e of each measurement in the axes of its
/// first pose and its covariance Σ, by Ceres. ρ is Cauchy's loss where a measurement closes a loop, so that a wrong one
/// of them bends the map little, else the identity. The first pose stays.

#include <vector>

#include "navigation/scan.h"
#include "navigation/uncertain_pose.h"

namespace robot_control::navigation {

struct GraphNode {
  PlanarPose pose;  ///< of the base in the map
  Scan scan;
  PlanarPose laser;  ///< in the base
};

struct Edge {
  std::size_t from = 0, to = 0;
  UncertainPose measured;  ///< of `to` in the frame of `from`
  bool closes = false;     ///< found by a search, not on the way
};

/// A node as seen from another one along the edges.
struct Reached {
  std::size_t node = 0;
  double length = 0;       ///< m along the edges
  UncertainPose relative;  ///< the mean is that of the present poses
};

struct PoseGraph {
  std::vector<GraphNode> nodes;
  std::vector<Edge> edges;

  /// Returns the nodes within `length` m along the edges, the nearest first, with the covariance along them.
  std::vector<Reached> reach(std::size_t start, double length) const;

  void optimise();
};

}  // namespace robot_control::navigation
