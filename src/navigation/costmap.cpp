#include "navigation/costmap.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace robot_control::navigation {
namespace {

constexpr float kNotMarked = -std::numeric_limits<float>::infinity();

Grid unknown_window() {
  const int size = static_cast<int>(kWindow / kCoarsest);
  return {size, size, kCoarsest, -kWindow / 2, -kWindow / 2, std::vector(std::size_t(size * size), kUnknownCell)};
}

/// Calls `visit` for each cell that the line crosses, in steps of half a cell, until it returns false.
template <class Visit>
void follow_ray(const Grid& grid, const PlanarPose& sensor, double angle, double length, Visit visit) {
  const double step = grid.resolution / 2, dx = std::cos(angle) * step, dy = std::sin(angle) * step;
  double x = sensor.x, y = sensor.y;
  Cell last{-1, -1};
  for (double along = 0; along < length; along += step, x += dx, y += dy) {
    const Cell cell = grid.cell_at(x, y);
    if (cell == last) continue;
    last = cell;
    if (!grid.contains(cell) || !visit(grid.index(cell), along)) return;
  }
}

}  // namespace

std::vector<float> distances(const std::vector<bool>& occupied, int columns, double resolution, double farthest) {
  const int reach = static_cast<int>(std::ceil(farthest / resolution)), size = static_cast<int>(occupied.size());
  std::vector<int> along(occupied.size());  // cells to the nearest one of the column, at most `reach`
  for (int i = 0; i < size; ++i)
    along[i] = occupied[i] ? 0 : i < columns ? reach : std::min(along[i - columns] + 1, reach);
  for (int i = size - columns - 1; i >= 0; --i) along[i] = std::min(along[i], along[i + columns] + 1);
  std::vector<float> result(occupied.size());
  for (int i = 0; i < size; ++i) {
    const int left = i % columns, right = columns - 1 - left;
    int square = along[i] * along[i];
    for (int k = 1; k < reach && k * k < square; ++k) {
      if (k <= left) square = std::min(square, k * k + along[i - k] * along[i - k]);
      if (k <= right) square = std::min(square, k * k + along[i + k] * along[i + k]);
    }
    result[i] = static_cast<float>(std::sqrt(square) * resolution);
  }
  return result;
}

Point end_of(const Scan& scan, const PlanarPose& sensor, std::size_t ray) {
  const double range = scan.ranges[ray], angle = sensor.yaw + scan.angle(ray);
  return {sensor.x + range * std::cos(angle), sensor.y + range * std::sin(angle)};
}

std::vector<Point> points_of(const Scan& scan, const PlanarPose& sensor) {
  std::vector<Point> points;
  points.reserve(scan.ranges.size());
  for (std::size_t ray = 0; ray < scan.ranges.size(); ++ray) {
    if (scan.hit(scan.ranges[ray])) points.push_back(end_of(scan, sensor, ray));
  }
  return points;
}

Costmap::Costmap(const Grid& map, Footprint footprint, bool unknown_is_free)
    : grid_(coarsened(map, kCoarsest)),
      footprint_(std::move(footprint)),
      farthest_(std::max(footprint_.circumscribed + kPadding, footprint_.inscribed + kFullClearance) +
                2 * grid_.resolution),
      unknown_(grid_.cells.size()),
      unknown_is_free_(unknown_is_free),
      marked_(grid_.cells.size(), kNotMarked) {
  std::vector<bool> walls(grid_.cells.size());
  for (std::size_t i = 0; i < walls.size(); ++i) walls[i] = grid_.cells[i] >= kOccupiedFrom;
  wall_distance_ = distances(walls, grid_.columns, grid_.resolution, farthest_);
  clear();
}

Costmap::Costmap(Footprint footprint) : Costmap(unknown_window(), std::move(footprint), true) {
  is_window_ = true;
}

void Costmap::centre_on(Point point, double now) {
  const Cell at = grid_.cell_at(point.x, point.y);
  const Cell by{at.column - grid_.columns / 2, at.row - grid_.rows / 2};
  if (!is_window_ || std::max(std::abs(by.column), std::abs(by.row)) * grid_.resolution <= kWindow / 8) return;
  std::vector<float> marked(marked_.size(), kNotMarked);
  std::vector<bool> unknown(unknown_.size(), true);
  std::map<std::size_t, double> blocked;
  for (std::size_t to = 0; to < marked.size(); ++to) {
    const Cell cell = grid_.cell_of(to), before{cell.column + by.column, cell.row + by.row};
    if (!grid_.contains(before)) continue;
    const std::size_t from = grid_.index(before);
    marked[to] = marked_[from];
    unknown[to] = unknown_[from];
    if (const auto found = blocked_.find(from); found != blocked_.end()) blocked[to] = found->second;
  }
  grid_.origin_x += by.column * grid_.resolution;
  grid_.origin_y += by.row * grid_.resolution;
  marked_ = std::move(marked), unknown_ = std::move(unknown), blocked_ = std::move(blocked);
  predicted_.clear();
  draw_zones();
  update(now);
}

void Costmap::set_zones(Zones zones) {
  zones_ = std::move(zones);
  draw_zones();
}

void Costmap::draw_zones() {
  const Grid& mask = zones_.mask();
  if (mask.cells.empty()) return;
  keep_out_.assign(grid_.cells.size(), false);
  const double within = 1e-6 * grid_.resolution;  // a border between two cells belongs to neither
  for (std::size_t i = 0; i < mask.cells.size(); ++i) {
    if (mask.cells[i] != kOccupiedCell) continue;
    const Cell cell = mask.cell_of(i);
    const double x = mask.origin_x + cell.column * mask.resolution, y = mask.origin_y + cell.row * mask.resolution;
    const Cell low = grid_.cell_at(x + within, y + within);
    const Cell high = grid_.cell_at(x + mask.resolution - within, y + mask.resolution - within);
    for (int row = std::max(low.row, 0); row <= std::min(high.row, grid_.rows - 1); ++row)
      for (int column = std::max(low.column, 0); column <= std::min(high.column, grid_.columns - 1); ++column)
        keep_out_[grid_.index({column, row})] = true;
  }
}

void Costmap::let_out(const PlanarPose& pose) {
  if (keep_out_.empty()) return;
  const double depth = exit_radius_ > 0 ? 0 : kZoneTolerance;
  if (!covers(pose, -depth, [&](Cell cell) { return keep_out(cell); })) {
    exit_radius_ = 0;
  } else if (exit_radius_ == 0) {
    exit_ = {pose.x, pose.y}, exit_radius_ = way_out(grid_.cell_at(pose.x, pose.y));
  }
}

double Costmap::way_out(Cell from) const {
  const double needed = footprint_.circumscribed + kPadding + grid_.resolution;
  const std::vector<float> away = distances(keep_out_, grid_.columns, grid_.resolution, needed);
  std::vector<int> steps(away.size(), -1);
  std::deque<Cell> open;
  const auto reach = [&](Cell cell, int count) {
    if (!grid_.contains(cell) || steps[grid_.index(cell)] >= 0) return;
    if (count > 0 && wall_distance_[grid_.index(cell)] < footprint_.inscribed) return;
    steps[grid_.index(cell)] = count;
    open.push_back(cell);
  };
  for (reach(from, 0); !open.empty(); open.pop_front()) {
    const Cell at = open.front();
    const int count = steps[grid_.index(at)];
    if (away[grid_.index(at)] >= static_cast<float>(needed)) return count * grid_.resolution + needed;
    for (const Cell step : {Cell{1, 0}, Cell{0, 1}, Cell{-1, 0}, Cell{0, -1}})
      reach({at.column + step.column, at.row + step.row}, count + 1);
  }
  return 0;
}

void Costmap::clear() {
  for (std::size_t i = 0; i < unknown_.size(); ++i) unknown_[i] = grid_.cells[i] < 0;
  std::fill(marked_.begin(), marked_.end(), kNotMarked);
  blocked_.clear();
  update(0);
}

Agreement Costmap::insert(const Scan& scan, const PlanarPose& sensor, double now) {
  Agreement result;
  std::vector<std::size_t> ends;
  for (std::size_t ray = 0; ray < scan.ranges.size(); ++ray) {
    const float range = scan.ranges[ray];
    const bool hit = scan.hit(range);
    if (!hit && !scan.nothing(range)) continue;
    const double length = hit ? range : scan.range_max, angle = sensor.yaw + scan.angle(ray);
    bool passed = false;
    follow_ray(grid_, sensor, angle, length - grid_.resolution, [&](std::size_t cell, double along) {
      if (hit || marked_[cell] < now - kMemory) marked_[cell] = kNotMarked;
      unknown_[cell] = false;
      passed |= wall_distance_[cell] == 0 && along < length - kBehindWall;
      return true;
    });
    if (!hit) continue;
    const Cell end = grid_.cell_at(sensor.x + range * std::cos(angle), sensor.y + range * std::sin(angle));
    const bool inside = grid_.contains(end);
    const std::size_t cell = inside ? grid_.index(end) : 0;
    const bool explained = inside && wall_distance_[cell] <= kExplained;
    result.rays += passed || explained || (inside ? grid_.cells[cell] >= 0 : !is_window_) ? 1 : 0;
    result.contradicting += passed ? 1 : 0;
    if (!inside) continue;
    if (explained) {
      result.explained += passed ? 0 : 1;
    } else {
      ends.push_back(cell);
      result.unexpected += !passed && grid_.cells[cell] >= 0 ? 1 : 0;
    }
  }
  for (const std::size_t cell : ends) {
    marked_[cell] = static_cast<float>(now);
    unknown_[cell] = false;
  }
  return result;
}

void Costmap::set_predicted(const std::vector<Point>& points) {
  predicted_.clear();
  for (const Point point : points) {
    const Cell cell = grid_.cell_at(point.x, point.y);
    if (grid_.contains(cell)) predicted_.push_back(grid_.index(cell));
  }
}

void Costmap::unmark(const std::vector<Point>& points) {
  for (const Point point : points) {
    const Cell cell = grid_.cell_at(point.x, point.y);
    if (grid_.contains(cell)) marked_[grid_.index(cell)] = kNotMarked;
  }
}

void Costmap::block(Point point, double now) {
  const Cell at = grid_.cell_at(point.x, point.y);
  for (const Cell cell : {at, Cell{at.column - 1, at.row}, Cell{at.column + 1, at.row}, Cell{at.column, at.row - 1},
                          Cell{at.column, at.row + 1}}) {
    if (grid_.contains(cell)) blocked_[grid_.index(cell)] = now;
  }
}

void Costmap::update(double now, bool predicted) {
  std::erase_if(blocked_, [&](const auto& cell) { return cell.second < now - kMemory; });
  distance_ = distances_at(now, predicted);
}

std::vector<float> Costmap::distances_at(double now, bool predicted) const {
  std::vector<bool> occupied(grid_.cells.size());
  const auto kept_out = [&](std::size_t i) {
    if (keep_out_.empty() || !keep_out_[i]) return false;
    const Cell cell = grid_.cell_of(i);
    return !(std::hypot(grid_.x_of(cell.column) - exit_.x, grid_.y_of(cell.row) - exit_.y) < exit_radius_);
  };
  for (std::size_t i = 0; i < occupied.size(); ++i) {
    const bool marked = marked_[i] > (grid_.cells[i] < 0 ? kNotMarked : now - kMemory);
    occupied[i] = wall_distance_[i] == 0 || marked || kept_out(i) || (unknown_[i] && !unknown_is_free_);
  }
  if (std::isfinite(now)) {
    if (predicted) {
      for (const std::size_t cell : predicted_) occupied[cell] = true;
    }
    for (const auto& [cell, at] : blocked_) occupied[cell] = true;
  }
  return distances(occupied, grid_.columns, grid_.resolution, farthest_);
}

Grid Costmap::picture(double now) const {
  const std::vector<float> distance = distances_at(now, true);
  Grid shown = grid_;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    const double air = distance[i] - footprint_.inscribed;
    shown.cells[i] = air > 0           ? static_cast<std::int8_t>(98 * std::max(0.0, 1 - air / kFullClearance))
                     : distance[i] > 0 ? std::int8_t{99}
                                       : kOccupiedCell;
  }
  return shown;
}

double Costmap::step_cost(Cell cell) const noexcept {
  return 1 + std::clamp(1 - (distance(cell) - footprint_.inscribed) / kFullClearance, 0.0, 1.0);
}

int Costmap::reach() const noexcept {
  return static_cast<int>((footprint_.circumscribed + kPadding) / grid_.resolution) + 1;
}

bool Costmap::interior(Cell cell) const noexcept {
  return grid_.contains({cell.column - reach(), cell.row - reach()}) &&
         grid_.contains({cell.column + reach(), cell.row + reach()});
}

template <class Taken>
bool Costmap::covers(const PlanarPose& pose, double padding, Taken taken) const {
  const Cell base = grid_.cell_at(pose.x, pose.y);
  const int reach = this->reach();
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  for (int row = base.row - reach; row <= base.row + reach; ++row) {
    for (int column = base.column - reach; column <= base.column + reach; ++column) {
      if (!grid_.contains({column, row}) || !taken(Cell{column, row})) continue;
      const double x = grid_.x_of(column) - pose.x, y = grid_.y_of(row) - pose.y;
      if (footprint_.distance({c * x + s * y, c * y - s * x}) <= padding) return true;
    }
  }
  return false;
}

bool Costmap::free(const PlanarPose& pose) const noexcept {
  const Cell base = grid_.cell_at(pose.x, pose.y);
  if (!interior(base)) return false;
  const double nearest = distance(base);
  if (nearest > footprint_.circumscribed + kPadding + grid_.resolution) return true;
  return nearest >= footprint_.inscribed && !covers(pose, kPadding, [&](Cell cell) { return occupied(cell); });
}

}  // namespace robot_control::navigation
