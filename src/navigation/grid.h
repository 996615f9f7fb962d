#pragma once
/// An occupancy grid as in nav_msgs/OccupancyGrid, without ROS.
///
/// Cell (column, row) begins at x = origin_x + column·resolution and y = origin_y + row·resolution of the frame `map`.
/// The cells lie row by row, that of the smallest y first. The grid is not turned against its frame.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace robot_control::navigation {

inline constexpr std::int8_t kUnknownCell = -1;
inline constexpr std::int8_t kFreeCell = 0;
inline constexpr std::int8_t kOccupiedCell = 100;
inline constexpr std::int8_t kOccupiedFrom = 65;  ///< %, as map_server's map_saver

/// 250 m × 250 m at 5 cm. A costmap of that size takes 0.4 GB.
inline constexpr std::size_t kMaxCells = 25'000'000;

/// m; farther coordinates are an error, so that a cell's number stays an int.
inline constexpr double kFarthest = 1e6;

struct Cell {
  int column = 0, row = 0;
  bool operator==(Cell other) const noexcept { return column == other.column && row == other.row; }
};

struct Grid {
  int columns = 0, rows = 0;
  double resolution = 0.05;           ///< m
  double origin_x = 0, origin_y = 0;  ///< m, corner of cell (0, 0)
  std::vector<std::int8_t> cells;     ///< kUnknownCell, or 0 … 100 % occupied

  bool contains(Cell cell) const noexcept {
    return cell.column >= 0 && cell.row >= 0 && cell.column < columns && cell.row < rows;
  }
  std::size_t index(Cell cell) const noexcept {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(cell.column);
  }
  Cell cell_of(std::size_t index) const noexcept {
    const auto width = static_cast<std::size_t>(columns);
    return {static_cast<int>(index % width), static_cast<int>(index / width)};
  }
  /// The place must be within ±kFarthest.
  Cell cell_at(double x, double y) const noexcept {
    return {static_cast<int>(std::floor((x - origin_x) / resolution)),
            static_cast<int>(std::floor((y - origin_y) / resolution))};
  }
  double x_of(int column) const noexcept { return origin_x + (column + 0.5) * resolution; }  ///< m, of its middle
  double y_of(int row) const noexcept { return origin_y + (row + 0.5) * resolution; }        ///< m, of its middle
};

/// Returns the grid with cells of n × n given ones, as many as stay within `coarsest` m; the fullest of them counts.
inline Grid coarsened(const Grid& given, double coarsest) {
  const int n = static_cast<int>(coarsest / given.resolution + 0.01);  // a float's 0.05 is more than 0.05
  if (n < 2) return given;
  Grid grid{
      (given.columns + n - 1) / n, (given.rows + n - 1) / n, given.resolution * n, given.origin_x, given.origin_y, {}};
  grid.cells.resize(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), kUnknownCell);
  for (int row = 0; row < given.rows; ++row) {
    for (int column = 0; column < given.columns; ++column) {
      std::int8_t& cell = grid.cells[grid.index({column / n, row / n})];
      cell = std::max(cell, given.cells[given.index({column, row})]);
    }
  }
  return grid;
}

/// The pose of a robot or sensor in a plane.
struct PlanarPose {
  double x = 0, y = 0, yaw = 0;  ///< m, m, rad
};

/// A velocity of the base, or a requested one; where only the direction counts, its length does not.
struct PlanarMotion {
  double linear = 0;   ///< m/s
  double angular = 0;  ///< rad/s
  double lateral = 0;  ///< m/s, to the left
};

/// Returns `inner`, given in the frame of `outer`, in the frame in which `outer` is given.
inline PlanarPose composed(const PlanarPose& outer, const PlanarPose& inner) noexcept {
  const double c = std::cos(outer.yaw), s = std::sin(outer.yaw);
  return {outer.x + c * inner.x - s * inner.y, outer.y + s * inner.x + c * inner.y, outer.yaw + inner.yaw};
}

/// Returns the frame of the pose's parent, as seen from the pose.
inline PlanarPose inverse(const PlanarPose& pose) noexcept {
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  return {-c * pose.x - s * pose.y, s * pose.x - c * pose.y, -pose.yaw};
}

}  // namespace robot_control::navigation
