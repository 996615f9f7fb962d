#include "navigation/moving_objects.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace robot_control::navigation {
namespace {

constexpr double kScanInterval = 0.4;  // s between the two scans
constexpr double kMaxGap = 0.25;       // m
constexpr double kMaxSize = 1.2;       // m
constexpr double kMinNewShare = 0.25;  // of the points
constexpr double kMinPassing = 0.1;    // m by which a ray has to pass a point
constexpr double kMaxSpeed = 2.5;      // m/s; a cluster that is farther away is another one
constexpr double kMinSpeed = 0.1;      // m/s
constexpr double kTimeStep = 0.1;      // s
constexpr double kContact = 0.02;      // m

/// Returns whether the rays on both sides of this point passed it.
bool was_free(const Scan& scan, const PlanarPose& sensor, Point at) {
  const double dx = at.x - sensor.x, dy = at.y - sensor.y;
  const double offset = std::atan2(dy, dx) - sensor.yaw - scan.angle_min;
  const double turns = offset / scan.angle_increment, whole = 2 * M_PI / std::abs(scan.angle_increment);
  const double between = turns - std::floor(turns / whole) * whole;
  const auto passed = [&](double ray) {
    if (ray < 0 || ray >= static_cast<double>(scan.ranges.size())) return false;
    const float range = scan.ranges[static_cast<std::size_t>(ray)];
    return range > std::hypot(dx, dy) + kMinPassing && range >= scan.range_min;
  };
  return passed(std::floor(between)) && passed(std::ceil(between));
}

}  // namespace

std::vector<MovingObjects::Cluster> MovingObjects::clusters_of(const Scan& scan, const PlanarPose& sensor) {
  std::vector<Cluster> clusters;
  for (const Point point : points_of(scan, sensor)) {
    if (!clusters.empty()) {
      const Point last = clusters.back().points.back();
      if (std::hypot(point.x - last.x, point.y - last.y) < kMaxGap) {
        clusters.back().points.push_back(point);
        continue;
      }
    }
    clusters.push_back({{point}, {}});
  }
  for (Cluster& cluster : clusters) {
    Point low = cluster.points[0], high = low;
    for (const Point point : cluster.points) {
      low = {std::min(low.x, point.x), std::min(low.y, point.y)};
      high = {std::max(high.x, point.x), std::max(high.y, point.y)};
    }
    cluster.middle = {(low.x + high.x) / 2, (low.y + high.y) / 2};
    if (std::hypot(high.x - low.x, high.y - low.y) > kMaxSize) cluster.points.clear();
  }
  std::erase_if(clusters, [](const Cluster& cluster) { return cluster.points.empty(); });
  return clusters;
}

std::vector<MovingObject> MovingObjects::update(const Scan& scan, const PlanarPose& sensor, double now) {
  if (!records_.empty() && now <= records_.back().at) records_.clear();
  while (records_.size() > 1 && records_[1].at <= now - kScanInterval) records_.pop_front();
  std::vector<MovingObject> objects;
  const std::vector<Cluster> clusters = clusters_of(scan, sensor);
  const ScanRecord* before = records_.empty() || now - records_[0].at > 2 * kScanInterval ? nullptr : &records_[0];
  const double elapsed = before != nullptr ? now - before->at : 0;
  for (std::size_t i = 0; before != nullptr && elapsed > kScanInterval / 2 && i < clusters.size(); ++i) {
    const Cluster& cluster = clusters[i];
    const auto fresh = std::count_if(cluster.points.begin(), cluster.points.end(),
                                     [&](Point point) { return was_free(before->scan, before->sensor, point); });
    if (static_cast<double>(fresh) < std::max(2.0, kMinNewShare * static_cast<double>(cluster.points.size()))) continue;
    double nearest = kMaxSpeed * elapsed;
    Point velocity;
    for (const Cluster& old : before->clusters) {
      const double dx = cluster.middle.x - old.middle.x, dy = cluster.middle.y - old.middle.y;
      if (std::hypot(dx, dy) >= nearest) continue;
      nearest = std::hypot(dx, dy);
      velocity = {dx / elapsed, dy / elapsed};
    }
    if (std::hypot(velocity.x, velocity.y) > kMinSpeed) objects.push_back({cluster.points, velocity});
  }
  records_.push_back({scan, sensor, now, clusters});
  return objects;
}

std::vector<Point> composed(const PlanarPose& frame, std::vector<Point> points) {
  for (Point& point : points) {
    const PlanarPose at = composed(frame, PlanarPose{point.x, point.y, 0});
    point = {at.x, at.y};
  }
  return points;
}

std::vector<MovingObject> composed(const PlanarPose& frame, std::vector<MovingObject> objects) {
  for (MovingObject& object : objects) {
    object.points = composed(frame, std::move(object.points));
    object.velocity = composed({0, 0, frame.yaw}, std::vector{object.velocity})[0];
  }
  return objects;
}

std::vector<Point> predicted_points(const std::vector<MovingObject>& objects, const Footprint& footprint) {
  std::vector<Point> places;
  for (const MovingObject& object : objects) {
    std::vector<Point> own;
    for (double time = 0; time <= kPredictionTime; time += kTimeStep) {
      for (const Point point : object.points)
        own.push_back({point.x + object.velocity.x * time, point.y + object.velocity.y * time});
    }
    const bool meets = std::ranges::any_of(own, [&](Point place) { return footprint.distance(place) < kContact; });
    if (meets) own = object.points;
    places.insert(places.end(), own.begin(), own.end());
  }
  return places;
}

void foresee(const std::vector<MovingObject>& objects, const PlanarPose& base, Costmap& costmap) {
  costmap.set_predicted(composed(base, predicted_points(composed(inverse(base), objects), costmap.footprint())));
  for (const MovingObject& object : objects) costmap.unmark(object.points);
}

}  // namespace robot_control::navigation
