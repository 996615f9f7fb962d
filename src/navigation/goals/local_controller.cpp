#include "navigation/goals/local_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control::navigation {
namespace {

constexpr double kRolloutStep = 0.1;               // s
constexpr int kBlock = 4;                          // steps of one draw of the noise
constexpr std::array kTemperatures = {0.6, 0.25};  // m, λ of each iteration
constexpr double kSpacing = 0.1;                   // m between points of the outline
constexpr double kMargin = kPadding + 0.005;       // m; between two points of the outline 5.6 cm are left
constexpr double kSoftMargin = 0.25;               // m
constexpr double kAhead = 0.3;                     // m
constexpr double kAlong = 0.04, kNearness = 0.5, kReverse = 3;
constexpr double kContactCost = 10;     // m, of one step
constexpr double kUnreachable = 5;      // m more than at the start
constexpr double kObjectMargin = 0.45;  // m
constexpr double kObjectDrift = 0.06;   // m/s, growth of the margin
constexpr double kObjectNearness = 30;  // of a step, per m of margin
constexpr double kObjectContact = 40;   // m, of one step
constexpr double kForesight = 6;        // s, in which the weight of an object falls to 1/e

/// Returns the distance to the nearest occupied cell, interpolated between the middles of cells.
double distance_at(const Costmap& costmap, double x, double y) {
  const Grid& grid = costmap.grid();
  const double half = grid.resolution / 2;
  const Cell low = grid.cell_at(x - half, y - half);
  const double u = (x - grid.x_of(low.column)) / grid.resolution, v = (y - grid.y_of(low.row)) / grid.resolution;
  const auto at = [&](int right, int up) { return costmap.distance({low.column + right, low.row + up}); };
  return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
}

double changed(double from, double to, double limit) {
  return from + std::clamp(to - from, -limit, limit);
}

PlanarMotion clamped(const PlanarMotion& motion, const DriveLimits& limits) {
  const double linear = std::clamp(motion.linear, -limits.reverse, limits.forward);
  const double angular = std::clamp(motion.angular, -limits.angular, limits.angular);
  const double share = std::sqrt(limits.centripetal_acceleration /
                                 std::max(std::abs(linear * angular), limits.centripetal_acceleration));
  return {share * linear, share * angular, std::clamp(motion.lateral, -limits.lateral, limits.lateral)};
}

}  // namespace

LocalController::LocalController(const Footprint& footprint) : footprint_(footprint) {
  for (std::size_t i = 0; i < footprint.corners.size(); ++i) {
    const Point a = footprint.corners[i], b = footprint.corners[(i + 1) % footprint.corners.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const Point last = border_.empty() ? Point{1e9, 0} : border_.back();
    if (std::hypot(a.x - last.x, a.y - last.y) > kSpacing / 2) border_.push_back(a);
    const int parts = static_cast<int>(std::ceil(length / kSpacing));
    for (int k = 1; k < parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      border_.push_back({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)});
    }
  }
}

void LocalController::reset() {
  mean_ = {};
  random_.seed();
}

void LocalController::draw(const DriveLimits& limits, int iteration) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const double scale = iteration == 0 ? 1 : 0.6;
  for (int i = 0; i < kSamples; ++i) {
    Sequence& sample = samples_[static_cast<std::size_t>(i)];
    if (i < 3) {
      const double share = i == 0 ? 1 : i == 1 ? 0 : 0.5;
      for (int k = 0; k < kSteps; ++k)
        sample[k] = {share * mean_[k].linear, share * mean_[k].angular, share * mean_[k].lateral};
    } else if (i < kSamples / 5) {
      const double linear = -limits.reverse + uniform(random_) * (limits.reverse + limits.forward);
      const double angular = limits.angular * (2 * uniform(random_) - 1);
      const double lateral = limits.lateral * (2 * uniform(random_) - 1);
      sample.fill({linear, angular, lateral});
    } else if (i < 2 * kSamples / 5) {
      const int turning = 2 + static_cast<int>(uniform(random_) * (kSteps - 6));
      const double turn = uniform(random_) < 0.5 ? -limits.angular : limits.angular;
      const double kind = uniform(random_), linear = kind < 0.6   ? limits.forward
                                                     : kind < 0.8 ? limits.forward / 2
                                                                  : -limits.reverse;
      for (int k = 0; k < kSteps; ++k) sample[k] = k < turning ? PlanarMotion{0, turn, 0} : PlanarMotion{linear, 0, 0};
    } else {
      PlanarMotion noise;
      for (int k = 0; k < kSteps; ++k) {
        if (k % kBlock == 0)
          noise = {scale * limits.forward / 2 * normal(random_), scale * 0.7 * limits.angular * normal(random_),
                   scale * limits.lateral / 2 * normal(random_)};
        sample[k] = {mean_[k].linear + noise.linear, mean_[k].angular + noise.angular,
                     mean_[k].lateral + noise.lateral};
      }
    }
  }
}

double LocalController::air(const Costmap& costmap, const PlanarPose& pose) const {
  const double base = costmap.distance(costmap.grid().cell_at(pose.x, pose.y));
  if (base > footprint_.circumscribed + kSoftMargin) return kSoftMargin;
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  double least = kSoftMargin;
  for (const Point point : border_)
    least =
        std::min(least, distance_at(costmap, pose.x + c * point.x - s * point.y, pose.y + s * point.x + c * point.y));
  return least;
}

double LocalController::cost(const Scene& scene, const Sequence& sequence) const {
  const DriveLimits& limits = scene.limits;
  PlanarPose pose = scene.pose;
  PlanarMotion motion = scene.measured;
  const double start = scene.to_goal.at(pose.x, pose.y);
  const double worst = (std::isfinite(start) ? start : 0) + kUnreachable;
  double total = 0, left = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double time = (k + 1) * kRolloutStep, change = limits.linear_acceleration * kRolloutStep;
    const PlanarMotion request = clamped(sequence[k], limits);
    motion = {changed(motion.linear, request.linear, change),
              changed(motion.angular, request.angular, limits.angular_acceleration * kRolloutStep),
              changed(motion.lateral, request.lateral, change)};
    const double middle = pose.yaw + motion.angular * kRolloutStep / 2, c = std::cos(middle), s = std::sin(middle);
    pose.x += (c * motion.linear - s * motion.lateral) * kRolloutStep;
    pose.y += (s * motion.linear + c * motion.lateral) * kRolloutStep;
    pose.yaw += motion.angular * kRolloutStep;
    const double length = std::hypot(motion.linear, motion.lateral) * kRolloutStep;
    left = std::min(scene.to_goal.at(pose.x, pose.y), worst);
    total += kAlong * left + (motion.linear < 0 ? kReverse * length : 0);
    const double least = air(scene.costmap, pose);
    const Cell cell = scene.costmap.grid().cell_at(pose.x, pose.y);
    if (motion.linear < 0 && (!scene.costmap.grid().contains(cell) || scene.costmap.unknown(cell)))
      total += kContactCost;
    if (least < kMargin) {
      total += kContactCost * (2 - least / kMargin);
    } else {
      total += kNearness * length * (kSoftMargin - least) / (kSoftMargin - kMargin);
    }
    const double weight = std::exp(-time / kForesight);
    for (const Disc& disc : scene.discs) {
      const double dx = disc.at.x + disc.velocity.x * time - pose.x, dy = disc.at.y + disc.velocity.y * time - pose.y;
      const double margin = kObjectMargin + kObjectDrift * time;
      if (std::hypot(dx, dy) > footprint_.circumscribed + disc.radius + margin) continue;
      const double cy = std::cos(pose.yaw), sy = std::sin(pose.yaw);
      const double away = footprint_.distance({cy * dx + sy * dy, cy * dy - sy * dx}) - disc.radius;
      total += weight * ((away < 0.02 ? kObjectContact : 0) + kObjectNearness * std::max(0.0, margin - away));
    }
  }
  const double ahead = scene.to_goal.at(pose.x + kAhead * std::cos(pose.yaw), pose.y + kAhead * std::sin(pose.yaw));
  return total + left + std::min(ahead, left + kAhead);
}

PlanarMotion LocalController::step(const DriveLimits& limits, const Costmap& costmap, const CostsToGoal& to_goal,
                                   const PlanarPose& pose, const PlanarMotion& measured,
                                   const std::vector<MovingObject>& objects) {
  Scene scene{limits, costmap, to_goal, pose, measured, {}};
  for (const MovingObject& object : objects) {
    Point low = object.points[0], high = low;
    for (const Point point : object.points) {
      low = {std::min(low.x, point.x), std::min(low.y, point.y)};
      high = {std::max(high.x, point.x), std::max(high.y, point.y)};
    }
    scene.discs.push_back({{(low.x + high.x) / 2, (low.y + high.y) / 2},
                           object.velocity,
                           std::hypot(high.x - low.x, high.y - low.y) / 2});
  }
  std::shift_left(mean_.begin(), mean_.end(), 1);
  std::vector<double> costs(kSamples);
  std::size_t best = 0;
  for (int iteration = 0; iteration < static_cast<int>(kTemperatures.size()); ++iteration) {
    draw(limits, iteration);
    for (std::size_t i = 0; i < samples_.size(); ++i) costs[i] = cost(scene, samples_[i]);
    best = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
    double sum = 0;
    mean_ = {};
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const double weight = std::exp((costs[best] - costs[i]) / kTemperatures[static_cast<std::size_t>(iteration)]);
      sum += weight;
      for (std::size_t k = 0; k < mean_.size(); ++k) {
        mean_[k].linear += weight * samples_[i][k].linear;
        mean_[k].angular += weight * samples_[i][k].angular;
        mean_[k].lateral += weight * samples_[i][k].lateral;
      }
    }
    for (PlanarMotion& motion : mean_)
      motion = clamped({motion.linear / sum, motion.angular / sum, motion.lateral / sum}, limits);
  }
  if (cost(scene, mean_) > costs[best] + kTemperatures.back())
    mean_ = samples_[best];  // the mean of two ways around an obstacle is neither
  return clamped(mean_[1], limits);
}

}  // namespace robot_control::navigation
