#pragma once
/// Refines a pose until the points of a scan lie at the walls of a PointField (iterative closest points).
///
/// The pose x = (x, y, yaw) minimises
///
///   Σᵢ wᵢ (nᵢᵀ(R pᵢ + t − qᵢ))² / σ² + (x − x₀)ᵀ Σ₀⁻¹ (x − x₀)
///
/// with points pᵢ of the scan, the nearest wall points qᵢ, their normals nᵢ, Cauchy's weights wᵢ, and the pose x₀ that
/// the odometry predicts with the covariance Σ₀. A point of no line counts in both axes.
///
/// A direction is observed if it holds kObserved of Σ wᵢ nᵢ nᵢᵀ / Σ wᵢ. Along the others, as along a corridor, the
/// normals are projected out, so that the odometry alone decides.

#include "navigation/mapping/point_field.h"
#include "navigation/uncertain_pose.h"

namespace robot_control::navigation {

inline constexpr double kObserved = 0.03;  ///< normals that err by 0.1 rad hold 0.01

struct Match {
  UncertainPose pose;
  int matched = 0;              ///< points that found a wall
  std::vector<bool> explained;  ///< for each point, whether it did
};

/// Begins at `start`; `predicted` is (x₀, Σ₀).
Match match(const PointField& walls, const std::vector<WallPoint>& seen, const PlanarPose& start,
            const UncertainPose& predicted);

}  // namespace robot_control::navigation
