#pragma once
/// A Costmap holds the poses that are free for a robot, according to the map, the laser and the outline of the robot.
///
/// A cell is occupied if the map says so (≥ 65 %), or if a ray ended there within the last kMemory. It is free
/// again once a ray passes it on its way to an obstacle; a ray without a return is no evidence of that. Unless
/// `unknown_is_free`, it is also occupied if neither the map nor a ray knows it. A ray that ends within kExplained of
/// an occupied cell of the map marks nothing. It has hit the map's own wall, within the error of the localisation.
///
/// A mark in a cell that the map does not know stays longer than kMemory, until a ray passes the cell. After kMemory
/// this may be a ray without a return.
///
/// Without a map the costmap is a window of kWindow whose cells are all unknown. It moves with the robot.
///
/// A map of finer cells is taken in cells of up to kCoarsest. A plan in cells of 1 cm would take minutes.
///
/// The cells of keep-out zones (zones.h) are occupied, too, but no scan contradicts them. A robot that is in one, more
/// than kZoneTolerance deep, may leave it. Until it has, no zone counts within the length of its shortest way out.
///
/// Rays also show whether map and pose can be true. An object that was added shortens a ray. Only an object that was
/// removed, or a wrong pose or map, lets a ray pass a wall of the map.

#include <map>
#include <utility>
#include <vector>

#include "navigation/footprint.h"
#include "navigation/grid.h"
#include "navigation/scan.h"
#include "navigation/zones.h"

namespace robot_control::navigation {

inline constexpr double kMemory = 10;           ///< s; less than kNoProgressTime of a goal that it blocks
inline constexpr double kExplained = 0.1;       ///< m
inline constexpr double kWindow = 16;           ///< m; more than twice what lasers of 8 m see ahead
inline constexpr double kBehindWall = 0.3;      ///< m; a ray that ends so far behind a wall contradicts the map
inline constexpr double kCoarsest = 0.05;       ///< m
inline constexpr double kFullClearance = 0.4;   ///< m of clearance from which on a cell has the lowest cost
inline constexpr double kZoneTolerance = 0.05;  ///< m, of the pose
inline constexpr double kGuardAir = 0.02;       ///< m of clearance with which the collision guard lets the robot pass
inline constexpr double kFollowerLag = 0.015;   ///< m by which the follower may be off its path beside an obstacle

/// m of clearance about the centre of an occupied cell. The guard lets every planned path pass.
inline constexpr double kPadding = 0.07;
static_assert(kPadding >= kGuardAir + kFollowerLag + 0.7 * kCoarsest);

/// Returns the end of a ray, in the frame in which `sensor` is given.
Point end_of(const Scan& scan, const PlanarPose& sensor, std::size_t ray);

/// Returns the ends of all rays that hit, likewise.
std::vector<Point> points_of(const Scan& scan, const PlanarPose& sensor);

struct Agreement {
  int rays = 0;           ///< those that hit; not those that end where the map knows nothing
  int explained = 0;      ///< end at a wall of the map
  int contradicting = 0;  ///< passed a wall of the map
  int unexpected = 0;     ///< end where the map is free
};

class Costmap {
 public:
  Costmap(const Grid& map, Footprint footprint, bool unknown_is_free);

  /// Makes a window without a map, around the origin. Space that no ray has seen is free.
  explicit Costmap(Footprint footprint);

  /// Returns whether there is no map, so that goals may be outside.
  bool is_window() const noexcept { return is_window_; }

  void set_zones(Zones zones);
  const Zones& zones() const noexcept { return zones_; }

  /// Lets a robot at this pose leave the keep-out zones in which it is. Called at each pose.
  void let_out(const PlanarPose& pose);

  /// Moves a window by whole cells, if the point is more than kWindow/8 from its middle. Marks that stay inside stay.
  void centre_on(Point point, double now);

  /// Inserts one scan whose sensor was at `sensor` in the map; `now` in s of any monotonic clock.
  Agreement insert(const Scan& scan, const PlanarPose& sensor, double now);

  /// Sets the points, in the map, that moving objects will occupy. They count as occupied until the next call.
  void set_predicted(const std::vector<Point>& points);

  /// Sets the point, in the map, in front of which the guard holds the robot. The cells around it count as occupied for
  /// kMemory, whatever a ray says: there is less room than the map and the scans show.
  void block(Point point, double now);

  /// Removes the marks at these points of moving objects, which are foreseen instead.
  void unmark(const std::vector<Point>& points);

  /// Updates the distances, which the functions below use; `predicted`: with the points of set_predicted. Takes about
  /// 20 ns a cell.
  void update(double now, bool predicted = true);

  /// Returns the grid as it is shown, with the predicted points. An occupied cell has 100, and one in which not even
  /// the inscribed circle is free has 99. Others have up to 98 by the nearness of obstacles. The distances are not
  /// changed.
  Grid picture(double now) const;

  bool occupied(Cell cell) const noexcept { return distance_[grid_.index(cell)] == 0; }
  bool unknown(Cell cell) const noexcept { return unknown_[grid_.index(cell)]; }
  bool keep_out(Cell cell) const noexcept { return !keep_out_.empty() && keep_out_[grid_.index(cell)]; }

  /// Returns the distance of the cell from the nearest occupied one, m, at most `farthest_`; 0 outside the map.
  double distance(Cell cell) const noexcept { return grid_.contains(cell) ? distance_[grid_.index(cell)] : 0; }

  /// Returns whether no outline at this cell reaches beyond the border.
  bool interior(Cell cell) const noexcept;

  /// Returns whether the outline, grown by kPadding, lies within the map and contains the centre of no occupied cell.
  /// The clearance is then at least kPadding less half a cell's diagonal, 3.5 cm at a resolution of 5 cm.
  bool free(const PlanarPose& pose) const noexcept;

  /// Returns the cost of a metre at this cell, d m from the nearest occupied one:
  ///
  ///   1 + max(0, 1 − (d − inscribed)/kFullClearance)
  double step_cost(Cell cell) const noexcept;

  const Grid& grid() const noexcept { return grid_; }
  const Footprint& footprint() const noexcept { return footprint_; }

  /// Forgets all scans.
  void clear();

 private:
  std::vector<float> distances_at(double now, bool predicted) const;
  int reach() const noexcept;  // cells of the grown outline from its base
  void draw_zones();
  double way_out(Cell from) const;  // m, to where the outline is outside the zones, and beyond; 0: nowhere

  /// Returns whether the outline, grown by `padding`, contains the centre of a cell for which `taken` is true.
  template <class Taken>
  bool covers(const PlanarPose& pose, double padding, Taken taken) const;

  Grid grid_;
  Footprint footprint_;
  double farthest_;                   ///< m, the largest distance that a function below distinguishes
  std::vector<float> wall_distance_;  ///< m, to the map's own walls
  std::vector<bool> unknown_;
  bool unknown_is_free_, is_window_ = false;
  std::vector<float> marked_;              ///< s, when a ray ended here; −∞: never, or passed since
  std::vector<std::size_t> predicted_;     ///< cells
  std::map<std::size_t, double> blocked_;  ///< s, when the guard last held the robot before this cell
  Zones zones_;
  std::vector<bool> keep_out_;  ///< empty: there are no zones
  Point exit_;
  double exit_radius_ = 0;       ///< m about `exit_`; within it no zone counts
  std::vector<float> distance_;  ///< m
};

/// Returns the distance of each cell from the nearest one that is set, in m, at most `farthest`.
std::vector<float> distances(const std::vector<bool>& occupied, int columns, double resolution, double farthest);

}  // namespace robot_control::navigation
