#pragma once
/// A Costmap says where a robot may stand, by the map, the laser and the outline of the robot.
///
/// A cell is occupied if the map says so (≥ 65 %), or if a ray ended there within the last kMemory and none passed it
/// since. Unless `unknown_is_free`, it is also occupied if neither the map nor a ray knows it. A ray that ends within
/// kExplained of an occupied cell of the map marks nothing. It has hit the map's own wall, within the error of the
/// localisation.
///
/// A map of finer cells is taken in cells of up to kCoarsest. A plan in cells of 1 cm would take minutes.
///
/// Rays also say whether map and pose can be true. Something that was added shortens a ray. Only a thing that is gone,
/// or an untrue pose or map, lets a ray pass a wall of the map.

#include <vector>

#include "navigation/footprint.h"
#include "navigation/grid.h"
#include "navigation/scan.h"

namespace robot_control::navigation {

inline constexpr double kMemory = 10;          ///< s; less than kNoProgressTime of a goal that it blocks
inline constexpr double kExplained = 0.1;      ///< m
inline constexpr double kBehindWall = 0.3;     ///< m; a ray that ends so far behind a wall contradicts the map
inline constexpr double kCoarsest = 0.05;      ///< m
inline constexpr double kFullClearance = 0.4;  ///< m of air from which on more is no better
inline constexpr double kPadding = 0.07;  ///< m of air about the outline: noise of the laser and lag of the follower

/// Returns the ends of all rays that hit, in the frame in which `sensor` is given.
std::vector<Point> points_of(const Scan& scan, const PlanarPose& sensor);

struct Agreement {
  int rays = 0;           ///< those that hit
  int explained = 0;      ///< end at a wall of the map
  int contradicting = 0;  ///< passed a wall of the map
  int unforeseen = 0;     ///< of the others, those that end where the map is free
};

class Costmap {
 public:
  Costmap(const Grid& map, Footprint footprint, bool unknown_is_free);

  /// Takes one scan whose sensor was at `sensor` in the map; `now` in s of any clock that does not turn back.
  Agreement insert(const Scan& scan, const PlanarPose& sensor, double now);

  /// Takes the places, in the map, that moving objects will take soon. They count as occupied until the next call.
  void foresee(const std::vector<Point>& places);

  /// Brings the distances up to date, which all below use. Takes about 20 ns a cell.
  void update(double now);

  bool occupied(Cell cell) const noexcept { return distance_[grid_.index(cell)] == 0; }
  bool unknown(Cell cell) const noexcept { return unknown_[grid_.index(cell)]; }

  /// Returns the distance of the cell from the nearest occupied one, m; 0 outside the map. A farther one than anything
  /// here asks for is that.
  double distance(Cell cell) const noexcept { return grid_.contains(cell) ? distance_[grid_.index(cell)] : 0; }

  /// Returns whether the outline, grown by kPadding, holds the middle of no occupied cell and lies within the map. The
  /// air that is then left is at least kPadding less half a cell's diagonal, 3.5 cm at a resolution of 5 cm.
  bool free(const PlanarPose& pose) const noexcept;

  /// Returns the cost of a metre at this cell, d m from the nearest occupied one:
  ///
  ///   1 + max(0, 1 − (d − inscribed)/kFullClearance)
  double step_cost(Cell cell) const noexcept;

  const Grid& grid() const noexcept { return grid_; }
  const Footprint& footprint() const noexcept { return footprint_; }

  /// Forgets what rays have marked and seen.
  void clear();

 private:
  Grid grid_;
  Footprint footprint_;
  double farthest_;                   ///< m, of the distances
  std::vector<float> wall_distance_;  ///< m, to the map's own walls
  std::vector<bool> unknown_;
  bool unknown_is_free_;
  std::vector<float> marked_;          ///< s, when a ray ended here; −∞: never, or passed since
  std::vector<std::size_t> foreseen_;  ///< cells
  std::vector<float> distance_;        ///< m
};

/// Returns the distance of each cell from the nearest one that is set, in m, at most `farthest`.
std::vector<float> distances(const std::vector<bool>& occupied, int columns, double resolution, double farthest);

}  // namespace robot_control::navigation
