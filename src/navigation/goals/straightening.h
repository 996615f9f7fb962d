#pragma once
/// These functions turn a path of lattice steps into one that follow_path drives. It is straightened as long as it
/// crosses no cell nearer to obstacles. A pose is set every kSpacing.

#include <vector>

#include "navigation/costmap.h"

namespace robot_control::navigation {

inline constexpr double kSpacing = 0.1;  ///< m

/// Returns whether the outline is free in a turn on the spot, in the shorter direction.
bool turn_is_free(const Costmap& costmap, Point at, double from, double to);

/// The path begins at the cell of `start` and ends at that of `goal`; the result begins and ends at these poses.
/// Each pose has the heading of the segment that ends there, the last one that of the goal.
std::vector<PlanarPose> straightened(const Costmap& costmap, const std::vector<PlanarPose>& path,
                                     const PlanarPose& start, const PlanarPose& goal);

/// m
double length_of(const std::vector<PlanarPose>& poses);

}  // namespace robot_control::navigation
