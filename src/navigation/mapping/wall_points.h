#pragma once
/// Points of walls with the direction in which each wall faces.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "navigation/grid.h"
#include "navigation/scan.h"

namespace robot_control::navigation {

struct WallPoint {
  Eigen::Vector2d at;                                ///< m
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< of length 1, towards the laser; zero: the points form no line
};

inline constexpr double kPointDistance = 0.05;  ///< m between two points of a scan; nearer ones add size alone

/// m; farther echoes are no walls. The size of a PointField grows with the square of the farthest one.
inline constexpr double kFarthestWall = 30;

/// Returns the echoes of a laser at this pose. A normal is that of the line through the neighbours within kLineRadius.
std::vector<WallPoint> walls_of(const Scan& scan, const PlanarPose& laser);

/// Returns one point for each side of an occupied cell that faces a free one; with `middle` those within kFarthestWall
/// of it along each axis.
std::vector<WallPoint> walls_of(const Grid& grid, const std::optional<Eigen::Vector2d>& middle = std::nullopt);

/// Returns the points of a frame at this pose in its parent.
std::vector<WallPoint> moved(std::vector<WallPoint> points, const PlanarPose& frame);

}  // namespace robot_control::navigation
