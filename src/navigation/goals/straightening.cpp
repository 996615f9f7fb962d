#include "navigation/goals/straightening.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control::navigation {
namespace {

double heading(Point a, Point b, bool back) {
  return std::atan2(b.y - a.y, b.x - a.x) + (back ? M_PI : 0);
}

/// Returns the cost of the straight segment with the outline along it; ∞ if it is not free.
double straight_cost(const Costmap& costmap, Point a, Point b, bool back) {
  const double length = std::hypot(b.x - a.x, b.y - a.y), resolution = costmap.grid().resolution;
  const double yaw = heading(a, b, back);
  const int steps = std::max(1, static_cast<int>(std::ceil(length / resolution)));
  double cost = 0;
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const PlanarPose pose{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), yaw};
    if (!costmap.free(pose)) return std::numeric_limits<double>::infinity();
    if (i > 0) cost += length / steps * costmap.step_cost(costmap.grid().cell_at(pose.x, pose.y));
  }
  return cost;
}

/// A corner of the path; `back`: the segment to it is driven backwards.
struct Vertex {
  Point at;
  bool back = false;
};

/// Returns the ends of the segments of a path, which turns on the spot at some of them.
std::vector<Vertex> vertices_of(const std::vector<PlanarPose>& path, const PlanarPose& start, const PlanarPose& goal) {
  std::vector<Vertex> vertices = {{{start.x, start.y}, false}};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double dx = path[i].x - path[i - 1].x, dy = path[i].y - path[i - 1].y;
    if (dx == 0 && dy == 0) continue;
    vertices.push_back({{path[i].x, path[i].y}, dx * std::cos(path[i].yaw) + dy * std::sin(path[i].yaw) < 0});
  }
  if (vertices.size() == 1) vertices.push_back({});
  vertices.back().at = {goal.x, goal.y};
  return vertices;
}

/// Leaves out the vertices between which the straight line is free and costs no more.
std::vector<Vertex> corners_of(const Costmap& costmap, const std::vector<Vertex>& given, double start_yaw,
                               double goal_yaw) {
  constexpr std::size_t kMisses = 20;  // vertices in a row to which there is no straight line
  std::vector<double> costs = {0};     // from the start along the given path
  for (std::size_t i = 1; i < given.size(); ++i) {
    costs.push_back(costs.back() + straight_cost(costmap, given[i - 1].at, given[i].at, given[i].back));
  }
  std::vector<Vertex> kept = {given[0]};
  double yaw = start_yaw;
  for (std::size_t i = 0; i + 1 < given.size();) {
    const bool back = given[i + 1].back;
    const Point from = given[i].at;
    std::size_t best = i + 1;
    for (std::size_t j = i + 2; j < given.size() && given[j].back == back && j <= best + kMisses; ++j) {
      const Point to = given[j].at;
      const double along = heading(from, to, back), straight = straight_cost(costmap, from, to, back);
      const double next = j + 1 < given.size() ? heading(to, given[j + 1].at, given[j + 1].back) : goal_yaw;
      const bool better = std::isfinite(straight) && !(straight > costs[j] - costs[i] + 1e-9);
      if (better && turn_is_free(costmap, from, yaw, along) && turn_is_free(costmap, to, along, next)) best = j;
    }
    yaw = heading(from, given[best].at, back);
    kept.push_back(given[best]);
    i = best;
  }
  return kept;
}

std::vector<PlanarPose> poses_of(const std::vector<Vertex>& vertices, double goal_yaw) {
  std::vector<PlanarPose> poses;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const Point a = vertices[i - 1].at, b = vertices[i].at;
    const double yaw = heading(a, b, vertices[i].back);
    const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(b.x - a.x, b.y - a.y) / kSpacing)));
    for (int k = i == 1 ? 0 : 1; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      poses.push_back({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), yaw});
    }
  }
  poses.back().yaw = goal_yaw;
  return poses;
}

}  // namespace

bool turn_is_free(const Costmap& costmap, Point at, double from, double to) {
  const double turn = std::remainder(to - from, 2 * M_PI);
  const int steps = static_cast<int>(std::ceil(std::abs(turn) / 0.1));
  for (int i = 0; i <= steps; ++i) {
    if (!costmap.free({at.x, at.y, from + turn * i / std::max(steps, 1)})) return false;
  }
  return true;
}

std::vector<PlanarPose> straightened(const Costmap& costmap, const std::vector<PlanarPose>& path,
                                     const PlanarPose& start, const PlanarPose& goal) {
  return poses_of(corners_of(costmap, vertices_of(path, start, goal), start.yaw, goal.yaw), goal.yaw);
}

double length_of(const std::vector<PlanarPose>& poses) {
  double length = 0;
  for (std::size_t i = 1; i < poses.size(); ++i)
    length += std::hypot(poses[i].x - poses[i - 1].x, poses[i].y - poses[i - 1].y);
  return length;
}

}  // namespace robot_control::navigation
