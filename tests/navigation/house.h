#pragma once
/// A house as text: one character a cell of 0.1 m, '#' a wall, '?' unknown; and a laser that looks at it.

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "navigation/costmap.h"

namespace robot_control::navigation::testing_house {

inline constexpr double kCell = 0.1;  ///< m

/// `rows` from the largest y down.
inline Grid grid_of(const std::vector<std::string>& rows) {
  Grid grid;
  grid.columns = static_cast<int>(rows[0].size()), grid.rows = static_cast<int>(rows.size()), grid.resolution = kCell;
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    for (const char cell : *row) {
      grid.cells.push_back(cell == '#' ? kOccupiedCell : cell == '?' ? kUnknownCell : kFreeCell);
    }
  }
  return grid;
}

/// Two rooms of 3 m × 3 m, beside each other, and a door of `door` m between them at the middle of the wall.
inline Grid two_rooms(double door) {
  Grid grid;
  grid.columns = 63, grid.rows = 32, grid.resolution = kCell;
  grid.cells.assign(63 * 32, kFreeCell);
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 63; ++column) {
      const bool wall = row == 0 || row == 31 || column == 0 || column == 62 ||
                        (column == 31 && std::abs(grid.y_of(row) - 1.6) > door / 2);
      if (wall) grid.cells[grid.index({column, row})] = kOccupiedCell;
    }
  }
  return grid;
}

/// The outline of these points.
inline Footprint hull(const std::vector<Point>& points) {
  return footprint_of([&](Point normal) {
    double reach = -std::numeric_limits<double>::infinity();
    for (const Point at : points) reach = std::max(reach, normal.x * at.x + normal.y * at.y);
    return reach;
  });
}

/// The outline of the shipped robot, nearly.
inline Footprint diffbot() {
  return hull({{0.12, 0.18},
               {0.1, 0.27},
               {-0.1, 0.27},
               {-0.28, 0.18},
               {0.12, -0.18},
               {0.1, -0.27},
               {-0.1, -0.27},
               {-0.28, -0.18}});
}

/// A scan of `rays` over a full turn up to 8 m, without noise.
inline Scan scan_of(const Grid& world, const PlanarPose& sensor, int rays = 360) {
  Scan scan{-M_PI, 2 * M_PI / rays, 0.05, 8.0, {}};
  for (int ray = 0; ray < rays; ++ray) {
    const double angle = sensor.yaw + scan.angle(static_cast<std::size_t>(ray));
    double range = 0;
    for (; range <= 8.0; range += 0.01) {
      const Cell cell = world.cell_at(sensor.x + range * std::cos(angle), sensor.y + range * std::sin(angle));
      if (world.contains(cell) && world.cells[world.index(cell)] == kOccupiedCell) break;
    }
    scan.ranges.push_back(range > 8.0 ? std::numeric_limits<float>::infinity() : static_cast<float>(range));
  }
  return scan;
}

}  // namespace robot_control::navigation::testing_house
