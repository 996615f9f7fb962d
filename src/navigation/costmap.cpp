#include "navigation/costmap.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

constexpr float kNever = -std::numeric_limits<float>::infinity();
constexpr double kFar = 1e12;  // cells²

/// Replaces f by min_q (p − q)² + f(q), the lower envelope of parabolas.
void transform(std::vector<double>& f, std::vector<double>& out, std::vector<int>& apex, std::vector<double>& from) {
  const int n = static_cast<int>(f.size());
  const auto at = [&](int i) { return f[static_cast<std::size_t>(i)] + static_cast<double>(i) * i; };
  int k = 0;
  apex[0] = 0, from[0] = -kFar, from[1] = kFar;
  for (int q = 1; q < n; ++q) {
    double cut = 0;
    for (;; --k) {
      const int p = apex[static_cast<std::size_t>(k)];
      cut = (at(q) - at(p)) / (2 * (q - p));
      if (cut > from[static_cast<std::size_t>(k)] || k == 0) break;
    }
    if (cut > from[static_cast<std::size_t>(k)]) ++k;
    apex[static_cast<std::size_t>(k)] = q;
    from[static_cast<std::size_t>(k)] = k == 0 ? -kFar : cut;
    from[static_cast<std::size_t>(k) + 1] = kFar;
  }
  k = 0;
  for (int q = 0; q < n; ++q) {
    while (from[static_cast<std::size_t>(k) + 1] < q) ++k;
    const int p = apex[static_cast<std::size_t>(k)];
    out[static_cast<std::size_t>(q)] = static_cast<double>(q - p) * (q - p) + f[static_cast<std::size_t>(p)];
  }
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

std::vector<float> distances(const std::vector<bool>& occupied, int columns, int rows, double resolution) {
  const auto size = static_cast<std::size_t>(std::max(columns, rows));
  std::vector<double> line, out(size), from(size + 1);
  std::vector<int> apex(size);
  std::vector<float> squares(occupied.size());
  const auto place = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  };
  for (int column = 0; column < columns; ++column) {
    line.resize(static_cast<std::size_t>(rows));
    for (int row = 0; row < rows; ++row) line[static_cast<std::size_t>(row)] = occupied[place(column, row)] ? 0 : kFar;
    transform(line, out, apex, from);
    for (int row = 0; row < rows; ++row)
      squares[place(column, row)] = static_cast<float>(out[static_cast<std::size_t>(row)]);
  }
  line.resize(static_cast<std::size_t>(columns));
  for (int row = 0; row < rows; ++row) {
    std::copy_n(&squares[place(0, row)], columns, line.begin());
    transform(line, out, apex, from);
    for (int column = 0; column < columns; ++column) {
      const double square = out[static_cast<std::size_t>(column)];
      squares[place(column, row)] = square >= kFar / 2 ? std::numeric_limits<float>::infinity()
                                                       : static_cast<float>(std::sqrt(square) * resolution);
    }
  }
  return squares;
}

std::vector<Point> points_of(const Scan& scan, const PlanarPose& sensor) {
  std::vector<Point> points;
  points.reserve(scan.ranges.size());
  for (std::size_t ray = 0; ray < scan.ranges.size(); ++ray) {
    const float range = scan.ranges[ray];
    if (!scan.hit(range)) continue;
    const double angle = sensor.yaw + scan.angle(ray);
    points.push_back({sensor.x + range * std::cos(angle), sensor.y + range * std::sin(angle)});
  }
  return points;
}

Costmap::Costmap(Grid map, Footprint footprint, bool unknown_is_free)
    : grid_(std::move(map)),
      footprint_(std::move(footprint)),
      covered_(kHeadings),
      unknown_(grid_.cells.size()),
      unknown_is_free_(unknown_is_free),
      marked_(grid_.cells.size(), kNever) {
  std::vector<bool> walls(grid_.cells.size());
  for (std::size_t i = 0; i < walls.size(); ++i) walls[i] = grid_.cells[i] >= 65;
  wall_distance_ = distances(walls, grid_.columns, grid_.rows, grid_.resolution);
  const int reach = static_cast<int>(std::ceil((footprint_.circumscribed + kPadding) / grid_.resolution));
  for (int heading = 0; heading < kHeadings; ++heading) {
    const double yaw = 2 * M_PI * heading / kHeadings, c = std::cos(yaw), s = std::sin(yaw);
    for (int row = -reach; row <= reach; ++row) {
      for (int column = -reach; column <= reach; ++column) {
        const double x = column * grid_.resolution, y = row * grid_.resolution;
        if (footprint_.distance({c * x + s * y, c * y - s * x}) <= kPadding) {
          covered_[static_cast<std::size_t>(heading)].push_back({column, row});
        }
      }
    }
  }
  clear();
}

void Costmap::clear() {
  for (std::size_t i = 0; i < unknown_.size(); ++i) unknown_[i] = grid_.cells[i] < 0;
  std::fill(marked_.begin(), marked_.end(), kNever);
  update(0);
}

Agreement Costmap::insert(const Scan& scan, const PlanarPose& sensor, double now) {
  Agreement result;
  std::vector<std::size_t> ends;
  for (std::size_t ray = 0; ray < scan.ranges.size(); ++ray) {
    const float range = scan.ranges[ray];
    const bool hit = scan.hit(range);
    if (!hit && !(range > scan.range_max)) continue;
    const double length = hit ? range : scan.range_max, angle = sensor.yaw + scan.angle(ray);
    bool passed = false;
    follow_ray(grid_, sensor, angle, length - grid_.resolution, [&](std::size_t cell, double along) {
      marked_[cell] = kNever;
      unknown_[cell] = false;
      passed |= wall_distance_[cell] == 0 && along < length - kBehindWall;
      return true;
    });
    if (!hit) continue;
    ++result.rays;
    result.contradicting += passed ? 1 : 0;
    const Cell end = grid_.cell_at(sensor.x + range * std::cos(angle), sensor.y + range * std::sin(angle));
    if (!grid_.contains(end)) continue;
    const std::size_t cell = grid_.index(end);
    if (wall_distance_[cell] <= kExplained) {
      result.explained += passed ? 0 : 1;
    } else {
      ends.push_back(cell);
      result.unforeseen += !passed && grid_.cells[cell] >= 0 ? 1 : 0;
    }
  }
  for (const std::size_t cell : ends) {
    marked_[cell] = static_cast<float>(now);
    unknown_[cell] = false;
  }
  return result;
}

void Costmap::foresee(const std::vector<Point>& places) {
  foreseen_.clear();
  for (const Point place : places) {
    const Cell cell = grid_.cell_at(place.x, place.y);
    if (grid_.contains(cell)) foreseen_.push_back(grid_.index(cell));
  }
}

void Costmap::update(double now) {
  std::vector<bool> occupied(grid_.cells.size());
  for (std::size_t i = 0; i < occupied.size(); ++i) {
    occupied[i] = wall_distance_[i] == 0 || marked_[i] > now - kMemory || (unknown_[i] && !unknown_is_free_);
  }
  if (std::isfinite(now)) {
    for (const std::size_t cell : foreseen_) occupied[cell] = true;
  }
  distance_ = distances(occupied, grid_.columns, grid_.rows, grid_.resolution);
}

bool Costmap::free(const PlanarPose& pose) const noexcept {
  const Cell base = grid_.cell_at(pose.x, pose.y);
  const double nearest = distance(base);
  if (nearest > footprint_.circumscribed + kPadding + grid_.resolution && std::isfinite(nearest)) {
    const int reach = static_cast<int>((footprint_.circumscribed + kPadding) / grid_.resolution) + 1;
    return base.column >= reach && base.row >= reach && base.column < grid_.columns - reach &&
           base.row < grid_.rows - reach;
  }
  if (nearest < footprint_.inscribed) return false;
  const double turn = std::remainder(pose.yaw, 2 * M_PI) / (2 * M_PI) * kHeadings;
  const auto heading = static_cast<std::size_t>((static_cast<int>(std::lround(turn)) + kHeadings) % kHeadings);
  return std::all_of(covered_[heading].begin(), covered_[heading].end(), [&](Cell offset) {
    const Cell cell{base.column + offset.column, base.row + offset.row};
    return grid_.contains(cell) && distance_[grid_.index(cell)] > 0;
  });
}

}  // namespace robot_control
