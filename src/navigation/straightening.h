#pragma once
/// These functions make a way of lattice steps into one that follow_path drives. It is straightened as far as no cell
/// nearer to obstacles is crossed. A pose is set every kSpacing.

#include <vector>

#include "navigation/costmap.h"

namespace robot_control::navigation {

inline constexpr double kSpacing = 0.1;  ///< m

/// Returns whether the outline is free in a turn on the spot, in the shorter direction.
bool turn_is_free(const Costmap& costmap, Point at, double from, double to);

/// The way begins at the cell of `start` and ends at that of `goal`; the result begins and ends at these themselves.
/// Each pose has the heading of the segment that ends there, the last one that of the goal.
std::vector<PlanarPose> straightened(const Costmap& costmap, const std::vector<PlanarPose>& way,
                                     const PlanarPose& start, const PlanarPose& goal);

/// m
double length_of(const std::vector<PlanarPose>& poses);

}  // namespace robot_control::navigation
