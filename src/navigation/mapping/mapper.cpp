#include "navigation/mapping/mapper.h"

#include <algorithm>
#include <optional>
#include <unordered_set>
#include <utility>

#include "navigation/mapping/ray_grid.h"
#include "navigation/mapping/scan_matcher.h"

namespace robot_control::navigation {
namespace {

constexpr double kMatchDistance = 0.05, kMatchTurn = 2 * M_PI / 180;  // m, rad between two matches
constexpr double kNodeDistance = 0.6, kNodeTurn = 15 * M_PI / 180;    // m, rad between two nodes
constexpr double kLocalLength = 6,
                 kLastLength = 3;                // m along the edges: of the walls to match with, of those to search
constexpr double kCell = 0.05, kWideCell = 0.1;  // m, of a field; of that of the whole map
constexpr double kMaxSearch = 10;                // m
constexpr int kMinPoints = 20;                   // fewer tell nothing
constexpr double kMinMatched = 0.75;             // of those that match or contradict; 0.85 and more on true ways
constexpr double kFreeMargin = 0.3;              // m before a wall, within which a point does not contradict
constexpr double kLoopScore = 0.55, kFoundScore = 0.65;  // of a search for a loop, for a lost robot
constexpr double kJump = 2, kTurnJump = 0.5;             // m, rad, of an odometry that slipped
constexpr double kUnlike = 0.9;  // of the score of the best place, above which another one is as good
constexpr std::size_t kSearchPoints = 250;
constexpr std::size_t kMaxRecent = 8, kMinRecent = 3;  // scans of a robot that is lost, kNodeDistance apart
const Eigen::Vector3d kNear(0.3, 0.3, 0.2);            // deviation of a given pose
const Eigen::Vector3d kSlip(0.005, 0.005, 0.005);      // of a step: wheels that slip do more than the odometry knows

double deviation(const UncertainPose& pose) {
  return std::sqrt(
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(pose.covariance.topLeftCorner<2, 2>()).eigenvalues()[1]);
}

SearchWindow window_of(const UncertainPose& predicted) {
  return {predicted.mean, std::min(3 * deviation(predicted), kMaxSearch),
          std::min(3 * std::sqrt(predicted.covariance(2, 2)), M_PI)};
}

/// Returns one point for each cell of this size.
std::vector<WallPoint> thinned(const std::vector<WallPoint>& points, double size) {
  std::unordered_set<std::int64_t> taken;
  std::vector<WallPoint> result;
  for (const WallPoint& point : points) {
    const auto x = static_cast<std::int64_t>(std::floor(point.at.x() / size));
    const auto y = static_cast<std::int64_t>(std::floor(point.at.y() / size));
    if (taken.insert((x << 32) ^ (y & 0xffffffff)).second) result.push_back(point);
  }
  return result;
}

/// Returns at most kSearchPoints of them, evenly.
std::vector<WallPoint> few(std::vector<WallPoint> points) {
  const std::size_t count = std::min(points.size(), kSearchPoints);
  for (std::size_t i = 0; i < count; ++i) points[i] = points[i * points.size() / count];
  points.resize(count);
  return points;
}

void append(std::vector<WallPoint>& points, std::vector<WallPoint> more) {
  points.insert(points.end(), more.begin(), more.end());
}

/// Returns how different two views are; up to 1 one of them is enough. Views over more than half a turn overlap by half
/// a turn at least.
double difference(const PlanarPose& relative, const Scan& scan) {
  const double view = std::abs(scan.angle_increment) * static_cast<double>(scan.ranges.size());
  const double turn = std::abs(std::remainder(relative.yaw, 2 * M_PI));
  return std::max(std::hypot(relative.x, relative.y) / kNodeDistance, turn / std::max(kNodeTurn, view - M_PI));
}

/// Returns whether this scan saw free space at this place of its base.
bool saw_free(const GraphNode& node, const Eigen::Vector2d& at) {
  const PlanarPose seen = composed(inverse(node.laser), {at.x(), at.y(), 0});
  const double turn = std::remainder(std::atan2(seen.y, seen.x) - node.scan.angle_min, 2 * M_PI);
  const double ray = std::round(
      (turn * node.scan.angle_increment < 0 ? turn + std::copysign(2 * M_PI, node.scan.angle_increment) : turn) /
      node.scan.angle_increment);
  if (!(ray >= 0 && ray < static_cast<double>(node.scan.ranges.size()))) return false;
  const float range = node.scan.ranges[static_cast<std::size_t>(ray)];
  const double free = node.scan.hit(range) ? range : node.scan.nothing(range) ? node.scan.range_max : 0;
  return std::hypot(seen.x, seen.y) < free - kFreeMargin;
}

}  // namespace

struct Mapper::Parts {
  PoseGraph graph;
  std::size_t reference = 0;
  UncertainPose matched_at;             // in the frame of the reference, at the last match
  UncertainPose odometry, odometry_at;  // at the last scan, at the last match
  PlanarPose tried_at, drawn_at;        // odometry of the last match or attempt; pose of the last scan in the grid
  std::optional<PointField> walls;      // around the reference, in its frame
  std::vector<Reached> near;            // likewise
  std::optional<PointField> whole;      // of all walls in the map; made by a search, until a node is added
  Grid saved;
  RayGrid grid;
  double share = 1;
  bool lost = false, first = true;
  std::vector<std::pair<PlanarPose, std::vector<WallPoint>>> recent;  // odometry and points, while it is lost

  UncertainPose predicted() const {
    const PlanarPose step = composed(inverse(odometry_at.mean), odometry.mean);
    return composed(matched_at, {step, at_least(growth(odometry_at, odometry), kSlip)});
  }

  /// Returns the walls of the nodes within `length` m, in the frame of the node.
  std::vector<WallPoint> walls_around(std::size_t node, const std::vector<Reached>& around, double length) const {
    std::vector<WallPoint> points;
    for (const Reached& other : around) {
      if (other.length > length) break;
      append(points, moved(walls_of(graph.nodes[other.node].scan, graph.nodes[other.node].laser), other.relative.mean));
    }
    const PlanarPose& pose = graph.nodes[node].pose;
    const Eigen::Vector2d middle(pose.x, pose.y);
    if (!saved.cells.empty()) append(points, moved(walls_of(saved, middle), inverse(pose)));
    return thinned(points, kCell / 2);
  }

  void refer_to(std::size_t node, const UncertainPose& relative) {
    reference = node;
    matched_at = relative;
    near = graph.reach(node, kLocalLength);
    walls.emplace(walls_around(node, near, kLocalLength), kCell);
  }

  /// Returns whether the node saw free space at this place of its frame, or the saved map is free there.
  bool is_free(std::size_t node, const Eigen::Vector2d& at) const {
    if (saw_free(graph.nodes[node], at)) return true;
    const PlanarPose place = composed(graph.nodes[node].pose, {at.x(), at.y(), 0});
    const Cell cell = saved.cell_at(place.x, place.y);
    return saved.contains(cell) && saved.cells[saved.index(cell)] == kFreeCell;
  }

  /// Returns, of the points that match or contradict what the node saw, the part that match; 1 if they are too few.
  double share_of(const Match& found, const std::vector<WallPoint>& seen, std::size_t node) const {
    const std::vector<WallPoint> placed = moved(seen, found.pose.mean);
    int contradicting = 0;
    for (std::size_t i = 0; i < placed.size(); ++i) {
      if (!found.explained[i] && is_free(node, placed[i].at)) ++contradicting;
    }
    const int count = found.matched + contradicting;
    return count < kMinPoints ? 1 : static_cast<double>(found.matched) / count;
  }

  void draw(const Scan& scan, const PlanarPose& laser, const PlanarPose& pose) {
    grid.insert(scan, composed(pose, laser));
    drawn_at = pose;
  }

  void draw_again() {
    grid = RayGrid(saved);
    for (const GraphNode& node : graph.nodes) draw(node.scan, node.laser, node.pose);
  }

  void add_node(const Scan& scan, const PlanarPose& laser) {
    const PlanarPose pose =
        graph.nodes.empty() ? matched_at.mean : composed(graph.nodes[reference].pose, matched_at.mean);
    graph.nodes.push_back({pose, scan, laser});
    whole.reset();
    const std::size_t node = graph.nodes.size() - 1;
    if (node > 0) graph.edges.push_back({reference, node, matched_at});
    draw(scan, laser, pose);
    refer_to(node, {{}, at_least(Eigen::Matrix3d::Zero(), {0.01, 0.01, 0.003})});
    if (close_loop()) {
      graph.optimise();
      draw_again();
      refer_to(node, matched_at);
    }
  }

  bool close_loop() {
    const Reached* best = nullptr;
    double nearest = kLocalLength;
    const std::vector<Reached> all = graph.reach(reference, HUGE_VAL);
    for (const Reached& other : all) {
      const double away = std::hypot(other.relative.mean.x, other.relative.mean.y) - 3 * deviation(other.relative);
      if (other.length > 2 * kLocalLength && away < nearest) best = &other, nearest = away;
    }
    if (best == nullptr) return false;
    const UncertainPose expected = inverse(best->relative);
    PointField there(walls_around(best->node, graph.reach(best->node, kLocalLength), kLocalLength), kCell);
    const std::vector<WallPoint> here = thinned(walls_around(reference, near, kLastLength), 2 * kCell);
    const std::vector<WallPoint> points = few(here);
    const SearchWindow window = window_of(expected);
    const auto found = there.search(points, window, kLoopScore);
    if (!found || !found->proven || there.search(points, window, kUnlike * found->score, &found->pose)) return false;
    const Match closed = match(there, here, found->pose, expected);
    if (closed.matched < kMinPoints || share_of(closed, here, best->node) < kMinMatched) return false;
    graph.edges.push_back({best->node, reference, closed.pose, true});
    return true;
  }

  /// Searches the scan of a lost robot near the expected pose, then the last ones in the whole map.
  void find_again(const std::vector<WallPoint>& seen, const UncertainPose& expected) {
    const auto near_by = walls->search(few(seen), {expected.mean, kJump, kTurnJump}, kFoundScore);
    if (near_by && near_by->proven) return resume(reference, near_by->pose, seen);
    const auto step = [&](const PlanarPose& before) { return composed(inverse(before), odometry.mean); };
    const PlanarPose* last = recent.empty() ? nullptr : &recent.back().first;
    if (last != nullptr && std::hypot(step(*last).x, step(*last).y) < kNodeDistance / 2 &&
        std::abs(step(*last).yaw) < kNodeTurn)
      return;
    recent.emplace_back(odometry.mean, seen);
    if (recent.size() > kMaxRecent) recent.erase(recent.begin());
    if (recent.size() < kMinRecent) return;
    if (!whole) {
      std::vector<WallPoint> all = walls_of(saved);
      for (const GraphNode& node : graph.nodes) append(all, moved(walls_of(node.scan, node.laser), node.pose));
      whole.emplace(thinned(all, kWideCell / 2), kWideCell);
    }
    std::vector<WallPoint> points;
    for (const auto& [pose, some] : recent) append(points, moved(some, inverse(step(pose))));
    Eigen::AlignedBox2d box;
    for (const WallPoint& point : whole->points()) box.extend(point.at);
    const Eigen::Vector2d middle = box.center(), half = box.sizes() / 2;
    points = few(thinned(points, kWideCell));
    const SearchWindow everywhere{{middle.x(), middle.y(), 0}, half.maxCoeff(), M_PI};
    const auto found = whole->search(points, everywhere, kFoundScore);
    if (!found || !found->proven || whole->search(points, everywhere, kUnlike * found->score, &found->pose)) return;
    const auto away = [&](const GraphNode& node) {
      return difference(composed(inverse(node.pose), found->pose), node.scan);
    };
    const auto nearest = std::ranges::min_element(graph.nodes, {}, away);
    resume(static_cast<std::size_t>(nearest - graph.nodes.begin()), composed(inverse(nearest->pose), found->pose),
           seen);
  }

  /// Goes on at this pose in the frame of the node if the points match there.
  void resume(std::size_t node, const PlanarPose& pose, const std::vector<WallPoint>& seen) {
    const UncertainPose before = matched_at;
    const std::size_t from = reference;
    const UncertainPose found{pose, at_least(Eigen::Matrix3d::Zero(), {kWideCell, kWideCell, 0.05})};
    refer_to(node, found);
    const Match there = match(*walls, seen, pose, found);
    if (there.matched < kMinPoints || share_of(there, seen, node) < kMinMatched) return refer_to(from, before);
    odometry_at = odometry;
    matched_at = there.pose;
  }

  void match_with_walls(const Scan& scan, const PlanarPose& laser) {
    const std::vector<WallPoint> seen = walls_of(scan, laser);
    const UncertainPose expected = predicted();
    const Match found = match(*walls, seen, expected.mean, expected);
    share = share_of(found, seen, reference);
    lost = share < kMinMatched;
    if (lost) return find_again(seen, expected);
    recent.clear();
    matched_at = found.matched < kMinPoints ? expected : found.pose;
    odometry_at = odometry;
    const auto view = [&](const Reached& other) {
      return difference(composed(inverse(other.relative.mean), matched_at.mean), scan);
    };
    const auto best = std::ranges::min_element(near, {}, view);
    if (view(*best) > 1) return add_node(scan, laser);
    const PlanarPose pose = composed(graph.nodes[reference].pose, matched_at.mean);
    if (difference(composed(inverse(drawn_at), pose), scan) > 1) draw(scan, laser, pose);
    if (best->node == reference) return;
    const Eigen::Matrix3d turn = planar_rotation(-best->relative.mean.yaw);
    const PlanarPose relative = composed(inverse(best->relative.mean), matched_at.mean);
    refer_to(best->node, {relative, turn * matched_at.covariance * turn.transpose()});
  }

  void set_pose(const PlanarPose& pose) {
    const Eigen::Matrix3d spread = at_least(Eigen::Matrix3d::Zero(), kNear);
    odometry_at = odometry;
    first = true;
    if (graph.nodes.empty()) {
      matched_at = {pose, spread};
      return;
    }
    const auto away = [&](const GraphNode& node) { return std::hypot(node.pose.x - pose.x, node.pose.y - pose.y); };
    const auto nearest = std::ranges::min_element(graph.nodes, {}, away);
    refer_to(static_cast<std::size_t>(nearest - graph.nodes.begin()), {composed(inverse(nearest->pose), pose), spread});
  }
};

Mapper::Mapper() : parts_(std::make_unique<Parts>()) {}
Mapper::~Mapper() = default;
Mapper::Mapper(Mapper&&) noexcept = default;
Mapper& Mapper::operator=(Mapper&&) noexcept = default;

Mapper::Mapper(Grid saved) : Mapper() {
  parts_->saved = std::move(saved);
  parts_->graph.nodes.push_back({});
  parts_->draw_again();
  set_pose({});
}

Mapper::Mapper(PoseGraph saved) : Mapper() {
  parts_->graph = std::move(saved);
  parts_->draw_again();
  set_pose({});
}

void Mapper::set_pose(const PlanarPose& pose) {
  parts_->set_pose(pose);
}

void Mapper::update(const Scan& scan, const PlanarPose& sensor, const UncertainPose& odometry) {
  Parts& parts = *parts_;
  parts.odometry = odometry;
  const PlanarPose step = composed(inverse(parts.tried_at), odometry.mean);
  const bool first = std::exchange(parts.first, false);
  if (!first && std::hypot(step.x, step.y) < kMatchDistance && std::abs(step.yaw) < kMatchTurn) return;
  parts.tried_at = odometry.mean;
  if (first) parts.odometry_at = odometry;
  if (parts.graph.nodes.empty()) {
    if (walls_of(scan, sensor).size() < static_cast<std::size_t>(kMinPoints)) return;
    parts.matched_at = parts.predicted();
    parts.odometry_at = odometry;
    return parts.add_node(scan, sensor);
  }
  parts.match_with_walls(scan, sensor);
}

Anchor Mapper::anchor() const {
  const PlanarPose step = composed(inverse(parts_->odometry_at.mean), parts_->odometry.mean);
  return {parts_->reference, composed(parts_->matched_at.mean, step)};
}
PlanarPose Mapper::pose() const {
  const Anchor now = anchor();
  return parts_->graph.nodes.empty() ? now.relative : composed(parts_->graph.nodes[now.node].pose, now.relative);
}
PlanarPose Mapper::correction() const {
  return composed(pose(), inverse(parts_->odometry.mean));
}
double Mapper::matched() const noexcept {
  return parts_->share;
}
bool Mapper::fits() const noexcept {
  return !parts_->lost;
}
std::string Mapper::reason() const {
  if (fits()) return "";
  return "the scan matches the map in " + std::to_string(std::lround(100 * parts_->share)) +
         " % of its points, less than " + std::to_string(std::lround(100 * kMinMatched)) +
         " %: drive on in a mapped area, or load the map again";
}
Grid Mapper::grid() const {
  return parts_->grid.grid();
}
const PoseGraph& Mapper::graph() const noexcept {
  return parts_->graph;
}

}  // namespace robot_control::navigation
