#include "navigation/mapping/point_field.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace robot_control::navigation {
namespace {

constexpr double kDeviation = 2;  // cells, of an echo
constexpr double kFull = 255;     // of a cell
constexpr double kTurnReach = 5;  // m, at which one step of the heading moves a point by one cell

struct Offset {
  int column, row;
};

/// A square of 2^level × 2^level translations at one heading; its score bounds theirs.
struct Branch {
  double score;
  int level, heading, column, row;
  bool operator<(const Branch& other) const { return score < other.score; }
};

}  // namespace

PointField::PointField(std::vector<WallPoint> points, double resolution)
    : points_(std::move(points)), resolution_(resolution) {
  if (points_.empty()) return;
  Eigen::Vector2d low = points_[0].at, high = low;
  for (const WallPoint& point : points_) low = low.cwiseMin(point.at), high = high.cwiseMax(point.at);
  const double margin = resolution * ((1 << (kLevels - 1)) + kReach);
  corner_ = low.array() - margin;
  const Eigen::Vector2d size = (high - low).array() / resolution + 2 * margin / resolution + 1;  // cells
  if (!(size.prod() <= static_cast<double>(kMaxCells))) {
    points_.clear();
    return;
  }
  columns_ = static_cast<int>(size.x());
  rows_ = static_cast<int>(size.y());
  const std::size_t cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  nearest_.assign(cells, -1);
  std::vector<float> squares(cells, static_cast<float>(kReach * kReach));
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector2d at = (points_[i].at - corner_) / resolution;
    const int column = static_cast<int>(at.x()), row = static_cast<int>(at.y());
    for (int y = row - kReach; y <= row + kReach; ++y) {
      for (int x = column - kReach; x <= column + kReach; ++x) {
        const auto square = static_cast<float>((Eigen::Vector2d(x + 0.5, y + 0.5) - at).squaredNorm());
        const std::size_t cell =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
        if (square < squares[cell]) squares[cell] = square, nearest_[cell] = static_cast<std::int32_t>(i);
      }
    }
  }
  levels_.emplace_back(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (nearest_[cell] < 0) continue;
    levels_[0][cell] = static_cast<std::uint8_t>(kFull * std::exp(-squares[cell] / (2 * kDeviation * kDeviation)));
  }
}

const WallPoint* PointField::nearest(const Eigen::Vector2d& at) const noexcept {
  const Eigen::Vector2d cell = (at - corner_) / resolution_;
  if (!(cell.x() >= 0 && cell.y() >= 0 && cell.x() < columns_ && cell.y() < rows_)) return nullptr;
  const std::int32_t i = nearest_[static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(columns_) +
                                  static_cast<std::size_t>(cell.x())];
  return i < 0 ? nullptr : &points_[static_cast<std::size_t>(i)];
}

void PointField::make_levels() {
  for (int level = static_cast<int>(levels_.size()); level < kLevels; ++level) {
    const std::vector<std::uint8_t>& finer = levels_.back();
    std::vector<std::uint8_t> coarser(finer.size());
    const int half = 1 << (level - 1);
    const auto value = [&](int column, int row) {
      return column < columns_ && row < rows_ ? finer[static_cast<std::size_t>(row * columns_ + column)]
                                              : std::uint8_t{0};
    };
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        coarser[static_cast<std::size_t>(row * columns_ + column)] =
            std::max({value(column, row), value(column + half, row), value(column, row + half),
                      value(column + half, row + half)});
      }
    }
    levels_.push_back(std::move(coarser));
  }
}

std::optional<Found> PointField::search(const std::vector<WallPoint>& seen, const SearchWindow& window, double least,
                                        const PlanarPose* known, int max_bounds) {
  if (seen.empty() || points_.empty()) return std::nullopt;
  make_levels();
  const double step = resolution_ / kTurnReach;
  const int headings = static_cast<int>(window.turn / step), reach = static_cast<int>(window.distance / resolution_);
  std::vector<std::vector<Offset>> turned;
  for (int heading = -headings; heading <= headings; ++heading) {
    const PlanarPose pose{window.middle.x - corner_.x(), window.middle.y - corner_.y(),
                          window.middle.yaw + heading * step};
    std::vector<Offset>& cells = turned.emplace_back();
    for (const WallPoint& point : moved(seen, pose)) {
      cells.push_back({static_cast<int>(std::floor(point.at.x() / resolution_)),
                       static_cast<int>(std::floor(point.at.y() / resolution_))});
    }
  }
  std::priority_queue<Branch> open;
  int bounds = 0;
  const auto add = [&](int level, int heading, int column, int row) {
    if (column > reach || row > reach || ++bounds > max_bounds) return;
    const std::vector<std::uint8_t>& maxima = levels_[static_cast<std::size_t>(level)];
    int sum = 0;
    for (const Offset& cell : turned[static_cast<std::size_t>(heading)]) {
      const int x = cell.column + column, y = cell.row + row;
      if (x >= 0 && y >= 0 && x < columns_ && y < rows_) sum += maxima[static_cast<std::size_t>(y * columns_ + x)];
    }
    const double score = sum / (kFull * static_cast<double>(seen.size()));
    if (score >= least) open.push({score, level, heading, column, row});
  };
  const int square = 1 << (kLevels - 1);
  for (int heading = 0; heading < static_cast<int>(turned.size()); ++heading) {
    for (int row = -reach; row <= reach; row += square) {
      for (int column = -reach; column <= reach; column += square) add(kLevels - 1, heading, column, row);
    }
  }
  while (!open.empty()) {
    const Branch best = open.top();
    open.pop();
    const PlanarPose pose{window.middle.x + best.column * resolution_, window.middle.y + best.row * resolution_,
                          window.middle.yaw + (best.heading - headings) * step};
    if (bounds > max_bounds) return Found{pose, best.score, false};
    if (best.level == 0) {
      if (known == nullptr || std::hypot(pose.x - known->x, pose.y - known->y) > kSamePlace ||
          std::abs(std::remainder(pose.yaw - known->yaw, 2 * M_PI)) > kSameHeading)
        return Found{pose, best.score};
      continue;
    }
    const int level = best.level - 1, half = 1 << level;
    for (const int y : {0, half}) {
      for (const int x : {0, half}) add(level, best.heading, best.column + x, best.row + y);
    }
  }
  if (bounds > max_bounds) return Found{window.middle, 0, false};
  return std::nullopt;
}

}  // namespace robot_control::navigation
