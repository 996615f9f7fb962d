#include "navigation/goals/planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <unordered_map>
#include <utility>

#include "navigation/goals/straightening.h"
#include "signals/formatted_text.h"

namespace robot_control::navigation {
namespace {

constexpr int kSectors = 16;
constexpr std::array<Cell, kSectors> kSteps = {{{1, 0},
                                                {2, 1},
                                                {1, 1},
                                                {1, 2},
                                                {0, 1},
                                                {-1, 2},
                                                {-1, 1},
                                                {-2, 1},
                                                {-1, 0},
                                                {-2, -1},
                                                {-1, -1},
                                                {-1, -2},
                                                {0, -1},
                                                {1, -2},
                                                {1, -1},
                                                {2, -1}}};
constexpr float kUnreached = std::numeric_limits<float>::infinity();

double heading_of(int sector) {
  const Cell step = kSteps[static_cast<std::size_t>(sector)];
  return std::atan2(step.row, step.column);
}

struct Open {
  float cost;
  std::uint64_t state;
  bool operator<(const Open& other) const { return cost > other.cost; }  // the queue's top is the cheapest
};

/// Returns whether the goal is outside a window, or too near to its border.
bool beyond(const Costmap& costmap, const PlanarPose& goal) {
  return costmap.is_window() && !costmap.interior(costmap.grid().cell_at(goal.x, goal.y));
}

/// Returns whether the cell is one of the last at the border at which the outline may be.
bool at_border(const Costmap& costmap, Cell cell) {
  return costmap.interior(cell) &&
         !(costmap.interior({cell.column - 1, cell.row - 1}) && costmap.interior({cell.column + 1, cell.row + 1}));
}

/// Returns whether the outline may go from one pose to the next. The next pose is free, or neither is free and the next
/// one has no less clearance.
bool may_go(const Costmap& costmap, const PlanarPose& from, const PlanarPose& to) {
  if (costmap.free(to)) return true;
  const auto clearance = [&](const PlanarPose& pose) {
    return costmap.distance(costmap.grid().cell_at(pose.x, pose.y));
  };
  return !costmap.free(from) && clearance(to) >= clearance(from) && clearance(to) > 0;
}

/// The search over cells and headings.
class Search {
 public:
  Search(const Costmap& costmap, const PlanarPose& start, const PlanarPose& goal)
      : costmap_(costmap),
        grid_(costmap.grid()),
        goal_(goal),
        beyond_(beyond(costmap, goal)),
        goal_cell_(grid_.cell_at(goal.x, goal.y)),
        to_goal_(costs_to(costmap, goal, 1).costs) {
    // The turn from the start's own heading to that of a sector may be free where the nearest sector is not.
    const Cell cell = grid_.cell_at(start.x, start.y);
    for (int i = 0; i < kSectors; ++i) {
      const double turn = std::abs(std::remainder(heading_of(i) - start.yaw, 2 * M_PI));
      const bool possible = turn_is_free(costmap, {start.x, start.y}, start.yaw, heading_of(i));
      if (possible || i == sector(start.yaw)) reach(state(cell, i), turn / (2 * M_PI) * kSectors * kSectorCost, kStart);
    }
  }

  /// Returns the poses from start to goal; empty if there is no path.
  std::vector<PlanarPose> run() {
    while (!open_.empty()) {
      const std::uint64_t at = open_.top().state;
      open_.pop();
      Node& node = nodes_[at];
      if (node.closed) continue;
      node.closed = true;
      const double yaw = heading_of(static_cast<int>(at % kSectors));
      if (beyond_ ? at_border(costmap_, cell_of(at))
                  : cell_of(at) == goal_cell_ && turn_is_free(costmap_, {goal_.x, goal_.y}, yaw, goal_.yaw))
        return path_to(at);
      expand(at, node.cost);
    }
    return {};
  }

 private:
  static constexpr std::uint64_t kStart = std::numeric_limits<std::uint64_t>::max();

  struct Node {
    float cost = kUnreached;
    bool closed = false;
    std::uint64_t from = 0;
  };

  static int sector(double yaw) {
    int best = 0;
    for (int i = 1; i < kSectors; ++i) {
      if (std::cos(heading_of(i) - yaw) > std::cos(heading_of(best) - yaw)) best = i;
    }
    return best;
  }
  std::uint64_t state(Cell cell, int sector) const {
    return grid_.index(cell) * kSectors + static_cast<std::uint64_t>(sector);
  }
  Cell cell_of(std::uint64_t state) const { return grid_.cell_of(state / kSectors); }
  PlanarPose pose_of(std::uint64_t state) const {
    const Cell cell = cell_of(state);
    return {grid_.x_of(cell.column), grid_.y_of(cell.row), heading_of(static_cast<int>(state % kSectors))};
  }

  void reach(std::uint64_t state, double cost, std::uint64_t from) {
    Node& node = nodes_[state];
    if (node.closed || cost >= node.cost) return;
    node.cost = static_cast<float>(cost);
    node.from = from;
    open_.push({static_cast<float>(cost) + to_goal_[state / kSectors], state});
  }

  void expand(std::uint64_t at, double cost) {
    const Cell cell = cell_of(at);
    const int heading = static_cast<int>(at % kSectors);
    const PlanarPose here = pose_of(at);
    for (const int turn : {1, kSectors - 1}) {
      const std::uint64_t next = state(cell, (heading + turn) % kSectors);
      if (may_go(costmap_, here, pose_of(next))) reach(next, cost + kSectorCost, at);
    }
    const Cell step = kSteps[static_cast<std::size_t>(heading)];
    const double length = std::hypot(step.column, step.row) * grid_.resolution;
    for (const int sign : {1, -1}) {
      const Cell to{cell.column + sign * step.column, cell.row + sign * step.row};
      if (!grid_.contains(to) || to_goal_[grid_.index(to)] == kUnreached) continue;
      if (sign < 0 && costmap_.unknown(to)) continue;  // backwards only over what was seen
      const std::uint64_t next = state(to, heading);
      if (may_go(costmap_, here, pose_of(next)))
        reach(next, cost + length * costmap_.step_cost(to) * (sign < 0 ? kBackFactor : 1), at);
    }
  }

  std::vector<PlanarPose> path_to(std::uint64_t end) {
    std::vector<PlanarPose> poses;
    for (std::uint64_t at = end; at != kStart; at = nodes_[at].from) poses.push_back(pose_of(at));
    std::reverse(poses.begin(), poses.end());
    return poses;
  }

  const Costmap& costmap_;
  const Grid& grid_;
  PlanarPose goal_;
  bool beyond_;
  Cell goal_cell_;
  std::vector<float> to_goal_;
  std::unordered_map<std::uint64_t, Node> nodes_;
  std::priority_queue<Open> open_;
};

/// Returns the narrowest cell of the widest path and its distance from obstacles; nothing if there is no path.
std::optional<std::pair<Cell, double>> narrowest(const Costmap& costmap, Cell start, Cell goal) {
  const Grid& grid = costmap.grid();
  std::vector<float> width(grid.cells.size(), 0);  // of the widest path to the cell
  std::vector<std::size_t> at_cell(grid.cells.size());
  std::priority_queue<std::pair<float, std::size_t>> open;
  const auto reach = [&](Cell cell, float before, std::size_t narrow) {
    const std::size_t index = grid.index(cell);
    const auto own = static_cast<float>(costmap.distance(cell));
    const float wide = std::min(before, own);
    if (wide <= width[index]) return;
    width[index] = wide;
    at_cell[index] = own < before ? index : narrow;
    open.emplace(wide, index);
  };
  reach(start, kUnreached, grid.index(start));
  while (!open.empty()) {
    const auto [wide, index] = open.top();
    open.pop();
    if (wide < width[index]) continue;
    const Cell cell = grid.cell_of(index);
    if (cell == goal) return std::pair{grid.cell_of(at_cell[index]), double{wide}};
    for (const Cell step : {Cell{1, 0}, Cell{0, 1}, Cell{-1, 0}, Cell{0, -1}}) {
      const Cell next{cell.column + step.column, cell.row + step.row};
      if (grid.contains(next)) reach(next, wide, at_cell[index]);
    }
  }
  return std::nullopt;
}

std::string no_path_problem(const Costmap& costmap, Cell start, Cell goal) {
  const auto narrow = narrowest(costmap, start, goal);
  if (!narrow) return "no path: obstacles, keep-out zones or unknown space surround the goal or the robot";
  const double needed = 2 * (costmap.footprint().half_width + kPadding), wide = 2 * narrow->second;
  const Grid& grid = costmap.grid();
  const std::string where = formatted("Narrowest passage on the best route: %.2f m wide at (%.2f, %.2f) m", wide,
                                      grid.x_of(narrow->first.column), grid.y_of(narrow->first.row));
  if (wide < needed) return "no path: the robot does not fit. " + where + formatted("; needed %.2f m", needed);
  return "no path: the robot has no room to turn. " + where;
}

std::string goal_problem(const Costmap& costmap, const PlanarPose& goal) {
  const Grid& grid = costmap.grid();
  if (!std::isfinite(goal.x) || !std::isfinite(goal.y) || !std::isfinite(goal.yaw)) {
    return "the goal contains NaN or infinity";
  }
  const bool near = std::abs(goal.x) <= kFarthest && std::abs(goal.y) <= kFarthest;
  const Cell cell = near ? grid.cell_at(goal.x, goal.y) : Cell{-1, -1};
  const std::string at = formatted("the goal (%.2f, %.2f) m ", goal.x, goal.y);
  if (near && beyond(costmap, goal)) return "";
  if (!grid.contains(cell)) return at + "is outside the map";
  if (costmap.keep_out(cell)) return at + "is in a keep-out zone: choose another goal, or change navigate.zones";
  if (costmap.occupied(cell)) return at + (costmap.unknown(cell) ? "is in unknown space" : "is in an obstacle");
  if (costmap.free(goal)) return "";
  return at + formatted("is too near to an obstacle, a keep-out zone or unknown space: %.2f m from its base",
                        costmap.distance(cell));
}

}  // namespace

double CostsToGoal::at(double x, double y) const noexcept {
  const Cell cell = grid.cell_at(x, y);
  return grid.contains(cell) ? costs[grid.index(cell)] : kUnreached;
}

bool is_outside(const Costmap& costmap, const PlanarPose& goal) {
  return !costmap.is_window() && !costmap.grid().contains(costmap.grid().cell_at(goal.x, goal.y));
}

CostsToGoal costs_to(const Costmap& costmap, const PlanarPose& goal, double narrow_factor,
                     const std::optional<Point>& robot) {
  const double narrow = costmap.footprint().half_width + kPadding;
  const Grid& grid = costmap.grid();
  CostsToGoal result{{grid.columns, grid.rows, grid.resolution, grid.origin_x, grid.origin_y, {}},
                     std::vector(grid.cells.size(), kUnreached)};
  std::vector<float>& costs = result.costs;
  std::vector<Open> begin;
  if (beyond(costmap, goal)) {
    for (std::size_t i = 0; i < costs.size(); ++i) {
      const Cell cell = grid.cell_of(i);
      if (!at_border(costmap, cell) || costmap.distance(cell) < costmap.footprint().inscribed) continue;
      costs[i] = static_cast<float>(std::hypot(grid.x_of(cell.column) - goal.x, grid.y_of(cell.row) - goal.y));
      begin.push_back({costs[i], i});
    }
  } else if (!is_outside(costmap, goal)) {
    const std::size_t index = grid.index(grid.cell_at(goal.x, goal.y));
    costs[index] = 0;
    begin.push_back({0, index});
  }
  if (begin.empty()) return result;
  std::array<double, kSectors> lengths;
  std::ranges::transform(kSteps, lengths.begin(),
                         [&](Cell step) { return std::hypot(step.column, step.row) * grid.resolution; });
  // No step stays within a bucket, so that the cells of one are settled in any order: a heap takes ten times as long.
  const double width = 0.9 * grid.resolution;
  const float least = std::ranges::min(begin, {}, &Open::cost).cost;
  std::vector<std::vector<Open>> buckets;
  const auto push = [&](const Open& open, std::size_t from) {
    const std::size_t bucket = std::max(static_cast<std::size_t>((open.cost - least) / width), from);
    if (bucket >= buckets.size()) buckets.resize(bucket + 1);
    buckets[bucket].push_back(open);
  };
  for (const Open& open : begin) push(open, 0);
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    if (robot && least + static_cast<double>(i) * width > result.at(robot->x, robot->y) + kCostMargin) break;
    for (const Open& top : std::exchange(buckets[i], {})) {
      if (top.cost > costs[top.state]) continue;
      ++result.settled;
      const Cell cell = grid.cell_of(top.state);
      for (std::size_t k = 0; k < kSteps.size(); ++k) {
        const Cell next{cell.column + kSteps[k].column, cell.row + kSteps[k].row};
        if (!grid.contains(next)) continue;
        float& known = costs[grid.index(next)];
        if (known <= top.cost || costmap.distance(next) < costmap.footprint().inscribed) continue;
        const double factor = costmap.distance(next) < narrow ? narrow_factor : 1;
        const auto cost = static_cast<float>(top.cost + lengths[k] * factor * costmap.step_cost(next));
        if (cost >= known) continue;
        known = cost;
        push({cost, grid.index(next)}, i + 1);
      }
    }
  }
  return result;
}

Plan plan_path(const Costmap& costmap, const PlanarPose& start, const PlanarPose& goal) {
  constexpr double kSamePosition = 0.04;  // m; the end of a path is as exact
  Plan plan;
  plan.problem = goal_problem(costmap, goal);
  const Grid& grid = costmap.grid();
  const Cell from = grid.cell_at(start.x, start.y);
  if (plan.problem.empty() && !grid.contains(from)) plan.problem = "the robot is outside the map";
  if (plan.problem.empty() && costmap.occupied(from)) plan.problem = "the robot is in an obstacle of the map";
  if (!plan.problem.empty()) return plan;
  if (std::hypot(goal.x - start.x, goal.y - start.y) <
      kSamePosition) {                        // a path needs two points; the robot turns on the spot
    constexpr double kMinPathLength = 0.002;  // m
    const PlanarPose end{start.x + kMinPathLength * std::cos(start.yaw), start.y + kMinPathLength * std::sin(start.yaw),
                         goal.yaw};
    if (turn_is_free(costmap, {start.x, start.y}, start.yaw, goal.yaw)) return {{start, end}, kMinPathLength, ""};
  }
  const std::vector<PlanarPose> path = Search(costmap, start, goal).run();
  if (path.empty()) {
    plan.problem = no_path_problem(costmap, from, grid.cell_at(goal.x, goal.y));
    return plan;
  }
  plan.partial = beyond(costmap, goal);
  plan.poses = straightened(costmap, path, start, plan.partial ? path.back() : goal);
  plan.length = length_of(plan.poses);
  return plan;
}

double free_distance(const Costmap& costmap, const std::vector<PlanarPose>& poses, const PlanarPose& robot,
                     std::size_t& passed) {
  const auto away = [&](std::size_t i) { return std::hypot(poses[i].x - robot.x, poses[i].y - robot.y); };
  constexpr std::size_t kSearchedPoses = 20;  // a path that crosses itself is not left for its later part
  for (std::size_t i = passed; i < std::min(poses.size(), passed + kSearchedPoses); ++i) {
    if (away(i) < away(passed)) passed = i;
  }
  double along = 0;
  for (std::size_t i = passed + 1; i < poses.size(); ++i) {
    along += std::hypot(poses[i].x - poses[i - 1].x, poses[i].y - poses[i - 1].y);
    if (!may_go(costmap, poses[i - 1], poses[i])) return along;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace robot_control::navigation
