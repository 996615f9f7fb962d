#pragma once
/// Finds a path for an outline over a costmap, as poses that follow_path drives.
///
/// States are (cell, heading sector of 22.5°). Moves are one step along the heading, one step back, and a turn on the
/// spot by one sector. A step costs its length times Costmap::step_cost, one back kBackFactor times that, a sector
/// kSectorCost. A* is guided by the same cost without headings, from a search backwards from the goal.
/// MRPT's PlannerSimple2D takes a circle alone. The planners of OMPL draw samples. Their paths differ from run to run,
/// and a timeout is their only sign that there is no path. Therefore neither is used.
///
/// The path is then straightened (straightening.h). Every pose carries the robot's heading: follow_path drives a
/// segment backwards whose poses point against it.

#include <optional>
#include <string>
#include <vector>

#include "navigation/costmap.h"

namespace robot_control::navigation {

inline constexpr double kBackFactor = 3;
inline constexpr double kCostMargin = 10;    ///< m; a LocalController does not distinguish costs beyond 5 m
inline constexpr double kSectorCost = 0.15;  ///< m; 22.5° take 0.4 s, in which follow_path drives 0.2 m

struct Plan {
  std::vector<PlanarPose> poses;  ///< from start to goal; empty: there is no path
  double length = 0;              ///< m
  std::string problem;            ///< why there is none: a sentence without full stop
  bool partial = false;           ///< the path ends at the border of a window; the goal is outside
};

/// The cost from each cell to a goal, without headings. It is infinite where there is no path even for the inscribed
/// circle.
struct CostsToGoal {
  Grid grid;  ///< without cells
  std::vector<float> costs;
  std::size_t settled = 0;  ///< cells whose cost was computed

  /// Returns that of the cell; infinite outside the grid.
  double at(double x, double y) const noexcept;
};

/// The costs are length times Costmap::step_cost, and `narrow_factor` times that where the outline cannot be along any
/// heading but one. A goal outside a window counts from the window's border. None is finite if the goal is outside a
/// map. With `robot` those that exceed the cost there by kCostMargin need not be computed. They may then be infinite.
CostsToGoal costs_to(const Costmap& costmap, const PlanarPose& goal, double narrow_factor,
                     const std::optional<Point>& robot = std::nullopt);

/// Returns whether the goal is outside a map that is no window.
bool is_outside(const Costmap& costmap, const PlanarPose& goal);

/// The costmap is up to date (Costmap::update). A start that is not free may be left, as long as every step is freer
/// than the start or free. A path to a goal outside a window ends at its border, where its cost and the straight
/// remaining distance are the least together. Else a goal is refused outside the map, in an obstacle, in unknown
/// space, or too near to either. The problem names the narrowest point of the widest path if there is no path for the
/// outline.
Plan plan_path(const Costmap& costmap, const PlanarPose& start, const PlanarPose& goal);

/// Returns the distance along the poses to the first one that is not free, from the pose nearest to `robot` on; ∞ if
/// all are. Those by which a start that is not free is left count as free. `passed` is the number of that nearest pose
/// and is kept between calls; it never falls.
double free_distance(const Costmap& costmap, const std::vector<PlanarPose>& poses, const PlanarPose& robot,
                     std::size_t& passed);

}  // namespace robot_control::navigation
