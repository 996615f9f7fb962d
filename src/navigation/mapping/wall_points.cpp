#include "navigation/mapping/wall_points.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace robot_control::navigation {
namespace {

constexpr double kLineRadius = 0.15;  // m
constexpr double kGaps = 2.5;         // the radius contains at least so many gaps to the nearer neighbour
constexpr double kFlat = 0.1;         // variance across a line, of that along it

Eigen::Vector2d end_of_ray(const Scan& scan, std::size_t ray) {
  return scan.ranges[ray] * Eigen::Vector2d(std::cos(scan.angle(ray)), std::sin(scan.angle(ray)));
}

/// Returns the normal of the line of those echoes beside this one that lie within the radius; zero without a line.
Eigen::Vector2d normal_at(const std::vector<std::optional<Eigen::Vector2d>>& ends, std::size_t ray) {
  const auto gap = [&](std::size_t i) {
    return i < ends.size() && ends[i] ? (*ends[i] - *ends[ray]).norm() : HUGE_VAL;
  };
  const double nearer = std::min(gap(ray - 1), gap(ray + 1));
  const double radius = std::isfinite(nearer) ? std::max(kLineRadius, kGaps * nearer) : kLineRadius;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  int count = 0;
  const auto take = [&](std::size_t i) {
    if (!ends[i] || (*ends[i] - *ends[ray]).norm() > radius) return false;
    sum += *ends[i], squares += *ends[i] * ends[i]->transpose(), ++count;
    return true;
  };
  for (std::size_t i = ray; i < ends.size() && take(i); ++i) {
  }
  for (std::size_t i = ray; i-- > 0 && take(i);) {
  }
  if (count < 3) return Eigen::Vector2d::Zero();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> parts(squares / count - sum * sum.transpose() / (count * count));
  if (parts.eigenvalues()[0] > kFlat * parts.eigenvalues()[1]) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d across = parts.eigenvectors().col(0);
  return across.dot(*ends[ray]) > 0 ? Eigen::Vector2d(-across) : across;
}

}  // namespace

std::vector<WallPoint> walls_of(const Scan& scan, const PlanarPose& laser) {
  std::vector<std::optional<Eigen::Vector2d>> ends(scan.ranges.size());
  for (std::size_t ray = 0; ray < ends.size(); ++ray) {
    if (scan.hit(scan.ranges[ray]) && scan.ranges[ray] < kFarthestWall) ends[ray] = end_of_ray(scan, ray);
  }
  std::vector<WallPoint> points;
  for (std::size_t ray = 0; ray < ends.size(); ++ray) {
    if (!ends[ray] || (!points.empty() && (points.back().at - *ends[ray]).norm() < kPointDistance)) continue;
    points.push_back({*ends[ray], normal_at(ends, ray)});
  }
  return moved(std::move(points), laser);
}

std::vector<WallPoint> walls_of(const Grid& grid, const std::optional<Eigen::Vector2d>& middle) {
  Cell low, high{grid.columns, grid.rows};
  if (middle) {
    const Cell from = grid.cell_at(middle->x() - kFarthestWall, middle->y() - kFarthestWall);
    const Cell to = grid.cell_at(middle->x() + kFarthestWall, middle->y() + kFarthestWall);
    low = {std::max(low.column, from.column), std::max(low.row, from.row)};
    high = {std::min(high.column, to.column), std::min(high.row, to.row)};
  }
  std::vector<WallPoint> points;
  for (int row = low.row; row < high.row; ++row) {
    for (int column = low.column; column < high.column; ++column) {
      if (grid.cells[grid.index({column, row})] < kOccupiedFrom) continue;
      for (const auto& [x, y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const Cell beside{column + x, row + y};
        if (!grid.contains(beside)) continue;
        const std::int8_t cell = grid.cells[grid.index(beside)];
        if (cell == kUnknownCell || cell >= kOccupiedFrom) continue;
        const Eigen::Vector2d normal(x, y);
        points.push_back({Eigen::Vector2d(grid.x_of(column), grid.y_of(row)) + grid.resolution / 4 * normal, normal});
      }
    }
  }
  return points;
}

std::vector<WallPoint> moved(std::vector<WallPoint> points, const PlanarPose& frame) {
  const Eigen::Rotation2Dd turn(frame.yaw);
  for (WallPoint& point : points) {
    point.at = turn * point.at + Eigen::Vector2d(frame.x, frame.y);
    point.normal = turn * point.normal;
  }
  return points;
}

}  // namespace robot_control::navigation
