#include "navigation/mrpt/mrpt_grid.h"

#include <cmath>

namespace robot_control::navigation {

PlanarPose align(Grid& grid) {
  const double x = grid.origin_x, y = grid.origin_y;
  grid.origin_x = std::round(grid.origin_x / grid.resolution) * grid.resolution;
  grid.origin_y = std::round(grid.origin_y / grid.resolution) * grid.resolution;
  return {x - grid.origin_x, y - grid.origin_y, 0};
}

mrpt::maps::COccupancyGridMap2D mrpt_grid(const Grid& grid) {
  const auto width = static_cast<float>(grid.columns * grid.resolution);
  const auto height = static_cast<float>(grid.rows * grid.resolution);
  const auto x = static_cast<float>(grid.origin_x), y = static_cast<float>(grid.origin_y);
  mrpt::maps::COccupancyGridMap2D map(x, x + width, y, y + height, static_cast<float>(grid.resolution));
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::int8_t cell = grid.cells[grid.index({column, row})];
      if (cell == kUnknownCell) continue;
      map.setCell(column, row, 1 - static_cast<float>(cell) / 100);
    }
  }
  return map;
}

mrpt::maps::CSimplePointsMap wall_points(const Grid& grid) {
  mrpt::maps::CSimplePointsMap points;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (grid.cells[grid.index({column, row})] >= kOccupiedFrom)
        points.insertPoint(static_cast<float>(grid.x_of(column)), static_cast<float>(grid.y_of(row)));
    }
  }
  return points;
}

}  // namespace robot_control::navigation
