#include "navigation/smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control {
namespace {

double turned(double angle) {
  return std::remainder(angle, 2 * M_PI);
}

/// Returns the cost of the straight segment with the outline along it; ∞ if it is not free.
double straight_cost(const Costmap& costmap, Point a, Point b, bool back) {
  const double length = std::hypot(b.x - a.x, b.y - a.y), resolution = costmap.grid().resolution;
  const double yaw = std::atan2(b.y - a.y, b.x - a.x) + (back ? M_PI : 0);
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

/// A corner of the way; `back`: the segment to it is driven backwards.
struct Vertex {
  Point at;
  bool back = false;
};

double heading(Point a, Point b, bool back) {
  return std::atan2(b.y - a.y, b.x - a.x) + (back ? M_PI : 0);
}

/// The ends of the segments of a way, which turns on the spot at some of them.
std::vector<Vertex> vertices_of(const std::vector<PlanarPose>& way, const PlanarPose& start, const PlanarPose& goal) {
  std::vector<Vertex> vertices = {{{start.x, start.y}, false}};
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double dx = way[i].x - way[i - 1].x, dy = way[i].y - way[i - 1].y;
    if (dx == 0 && dy == 0) continue;
    vertices.push_back({{way[i].x, way[i].y}, dx * std::cos(way[i].yaw) + dy * std::sin(way[i].yaw) < 0});
  }
  if (vertices.size() == 1) vertices.push_back({});
  vertices.back().at = {goal.x, goal.y};
  return vertices;
}

/// Leaves out the vertices between which the straight way is free and costs no more.
std::vector<Vertex> straightened(const Costmap& costmap, const std::vector<Vertex>& given, double start_yaw,
                                 double goal_yaw) {
  constexpr std::size_t kMisses = 20;  // vertices in a row to which there is no straight way
  std::vector<double> costs = {0};     // from the start along the given way
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

/// Replaces corners by parabolas that begin and end on the segments, where the outline has room along them.
std::vector<Vertex> rounded(const Costmap& costmap, const std::vector<Vertex>& given) {
  constexpr double kLeg = 0.5, kLeast = 0.1, kMost = 2.0;  // m, rad, rad
  std::vector<Vertex> result = {given[0]};
  for (std::size_t i = 1; i < given.size(); ++i) {
    const Vertex& corner = given[i];
    if (i + 1 == given.size() || given[i + 1].back != corner.back) {
      result.push_back(corner);
      continue;
    }
    const Point a = given[i - 1].at, b = corner.at, c = given[i + 1].at;
    const double in = std::hypot(b.x - a.x, b.y - a.y), out = std::hypot(c.x - b.x, c.y - b.y);
    const double turn = std::abs(turned(heading(b, c, false) - heading(a, b, false)));
    std::vector<Vertex> curve;
    for (double leg = std::min({kLeg, in / 2, out / 2}); turn > kLeast && turn < kMost && leg > kSpacing; leg /= 2) {
      const Point begin{b.x + (a.x - b.x) * leg / in, b.y + (a.y - b.y) * leg / in};
      const Point end{b.x + (c.x - b.x) * leg / out, b.y + (c.y - b.y) * leg / out};
      const int pieces = 2 + static_cast<int>(turn / 0.15);
      curve = {{begin, corner.back}};
      bool free = true;
      for (int k = 1; k <= pieces && free; ++k) {
        const double t = static_cast<double>(k) / pieces, u = 1 - t;
        const Point at{u * u * begin.x + 2 * u * t * b.x + t * t * end.x,
                       u * u * begin.y + 2 * u * t * b.y + t * t * end.y};
        free = std::isfinite(straight_cost(costmap, curve.back().at, at, corner.back));
        curve.push_back({at, corner.back});
      }
      if (free) break;
      curve.clear();
    }
    if (curve.empty()) curve = {corner};
    result.insert(result.end(), curve.begin(), curve.end());
  }
  return result;
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
  const double turn = turned(to - from);
  const int steps = static_cast<int>(std::ceil(std::abs(turn) / 0.1));
  for (int i = 0; i <= steps; ++i) {
    if (!costmap.free({at.x, at.y, from + turn * i / std::max(steps, 1)})) return false;
  }
  return true;
}

std::vector<PlanarPose> smoothed(const Costmap& costmap, const std::vector<PlanarPose>& way, const PlanarPose& start,
                                 const PlanarPose& goal) {
  const std::vector<Vertex> vertices = straightened(costmap, vertices_of(way, start, goal), start.yaw, goal.yaw);
  return poses_of(rounded(costmap, vertices), goal.yaw);
}

double length_of(const std::vector<PlanarPose>& poses) {
  double length = 0;
  for (std::size_t i = 1; i < poses.size(); ++i)
    length += std::hypot(poses[i].x - poses[i - 1].x, poses[i].y - poses[i - 1].y);
  return length;
}

}  // namespace robot_control
