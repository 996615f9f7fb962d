#include "navigation/mapping/ray_grid.h"

#include <utility>

namespace robot_control::navigation {
namespace {

const double kStep = std::log(0.65 / 0.35);
constexpr double kMargin = 5;  // m that the grid grows beyond a ray

double length_of(const Scan& scan, float range) {
  if (scan.hit(range)) return std::min<double>(range, kMaxRay);
  return scan.nothing(range) ? std::min(scan.range_max, kMaxRay) : 0;
}

}  // namespace

RayGrid::RayGrid(const Grid& saved) : steps_(saved) {
  for (std::int8_t& cell : steps_.cells) {
    const double odds = std::log(std::clamp<double>(cell, 1, 99) / (100 - std::clamp<double>(cell, 1, 99)));
    const double steps = cell == kFreeCell ? -kMaxSteps : cell == kOccupiedCell ? kMaxSteps : odds / kStep;
    cell = static_cast<std::int8_t>(cell == kUnknownCell ? 0 : std::lround(steps));
  }
}

void RayGrid::include(double low_x, double low_y, double high_x, double high_y) {
  if (steps_.cells.empty()) {
    steps_.origin_x = std::floor(low_x / steps_.resolution) * steps_.resolution;
    steps_.origin_y = std::floor(low_y / steps_.resolution) * steps_.resolution;
  }
  const auto missing = [&](double below) {
    return below <= 0 ? 0 : static_cast<int>(std::ceil((below + kMargin) / steps_.resolution));
  };
  const int left = missing(steps_.origin_x - low_x), down = missing(steps_.origin_y - low_y);
  Grid grown = steps_;
  grown.columns += left + missing(high_x - steps_.origin_x - steps_.columns * steps_.resolution);
  grown.rows += down + missing(high_y - steps_.origin_y - steps_.rows * steps_.resolution);
  if (grown.columns == steps_.columns && grown.rows == steps_.rows) return;
  const std::size_t cells = static_cast<std::size_t>(grown.columns) * static_cast<std::size_t>(grown.rows);
  if (cells > kMaxCells) return;
  grown.origin_x -= left * grown.resolution, grown.origin_y -= down * grown.resolution;
  grown.cells.assign(cells, 0);
  for (int row = 0; row < steps_.rows; ++row) {
    std::copy_n(steps_.cells.begin() + static_cast<std::ptrdiff_t>(steps_.index({0, row})), steps_.columns,
                grown.cells.begin() + static_cast<std::ptrdiff_t>(grown.index({left, row + down})));
  }
  steps_ = std::move(grown);
}

void RayGrid::add(Cell cell, int steps) {
  if (!steps_.contains(cell)) return;
  std::int8_t& value = steps_.cells[steps_.index(cell)];
  value = static_cast<std::int8_t>(std::clamp(value + steps, -kMaxSteps, kMaxSteps));
}

void RayGrid::insert(const Scan& scan, const PlanarPose& laser) {
  double longest = 0;
  for (const float range : scan.ranges) longest = std::max(longest, length_of(scan, range));
  include(laser.x - longest, laser.y - longest, laser.x + longest, laser.y + longest);
  const Cell from = steps_.cell_at(laser.x, laser.y);
  std::vector<Cell> ends;
  for (std::size_t ray = 0; ray < scan.ranges.size(); ++ray) {
    const double length = length_of(scan, scan.ranges[ray]), angle = laser.yaw + scan.angle(ray);
    const Cell to = steps_.cell_at(laser.x + length * std::cos(angle), laser.y + length * std::sin(angle));
    const int across = to.column - from.column, up = to.row - from.row,
              count = std::max(std::abs(across), std::abs(up));
    for (int i = 0; i < count; ++i) {
      const double part = static_cast<double>(i) / count;
      add({from.column + static_cast<int>(std::lround(part * across)),
           from.row + static_cast<int>(std::lround(part * up))},
          -1);
    }
    if (scan.hit(scan.ranges[ray]) && scan.ranges[ray] < kMaxRay) ends.push_back(to);
  }
  for (const Cell end : ends) add(end, kHitSteps);
}

Grid RayGrid::grid() const {
  Grid grid = steps_;
  for (std::int8_t& cell : grid.cells) {
    if (cell != 0)
      cell = static_cast<std::int8_t>(std::lround(100 / (1 + std::exp(-kStep * cell))));
    else
      cell = kUnknownCell;
  }
  return grid;
}

}  // namespace robot_control::navigation
