#include "navigation/movers.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

constexpr double kApart = 0.4;      // s between the two scans
constexpr double kGap = 0.25;       // m
constexpr double kLargest = 1.2;    // m
constexpr double kNew = 0.25;       // of the points
constexpr double kThrough = 0.1;    // m by which a ray passed the place of a point
constexpr double kFastest = 2.5;    // m/s; what is farther away is another thing
constexpr double kSlowest = 0.1;    // m/s
constexpr double kTick = 0.1;       // s
constexpr double kTouching = 0.02;  // m

/// Returns whether the laser looked through this place, by the rays on both sides of it.
bool seen_free(const Scan& scan, const PlanarPose& sensor, Point at) {
  const double dx = at.x - sensor.x, dy = at.y - sensor.y;
  const double offset = std::atan2(dy, dx) - sensor.yaw - scan.angle_min;
  const double turns = offset / scan.angle_increment, whole = 2 * M_PI / std::abs(scan.angle_increment);
  const double between = turns - std::floor(turns / whole) * whole;
  const auto passed = [&](double ray) {
    if (ray < 0 || ray >= static_cast<double>(scan.ranges.size())) return false;
    const float range = scan.ranges[static_cast<std::size_t>(ray)];
    return range > std::hypot(dx, dy) + kThrough && range >= scan.range_min;
  };
  return passed(std::floor(between)) && passed(std::ceil(between));
}

}  // namespace

std::vector<Movers::Thing> Movers::things_of(const Scan& scan, const PlanarPose& sensor) {
  std::vector<Thing> things;
  for (const Point point : points_of(scan, sensor)) {
    if (!things.empty()) {
      const Point last = things.back().points.back();
      if (std::hypot(point.x - last.x, point.y - last.y) < kGap) {
        things.back().points.push_back(point);
        continue;
      }
    }
    things.push_back({{point}, {}});
  }
  for (Thing& thing : things) {
    Point low = thing.points[0], high = low;
    for (const Point point : thing.points) {
      low = {std::min(low.x, point.x), std::min(low.y, point.y)};
      high = {std::max(high.x, point.x), std::max(high.y, point.y)};
    }
    thing.middle = {(low.x + high.x) / 2, (low.y + high.y) / 2};
    if (std::hypot(high.x - low.x, high.y - low.y) > kLargest) thing.points.clear();
  }
  std::erase_if(things, [](const Thing& thing) { return thing.points.empty(); });
  return things;
}

std::vector<Mover> Movers::update(const Scan& scan, const PlanarPose& sensor, double now) {
  if (!views_.empty() && now <= views_.back().at) views_.clear();
  while (views_.size() > 1 && views_[1].at <= now - kApart) views_.pop_front();
  std::vector<Mover> movers;
  const std::vector<Thing> things = things_of(scan, sensor);
  const View* before = views_.empty() || now - views_[0].at > 2 * kApart ? nullptr : &views_[0];
  const double elapsed = before != nullptr ? now - before->at : 0;
  for (std::size_t i = 0; before != nullptr && elapsed > kApart / 2 && i < things.size(); ++i) {
    const Thing& thing = things[i];
    const auto fresh = std::count_if(thing.points.begin(), thing.points.end(),
                                     [&](Point point) { return seen_free(before->scan, before->sensor, point); });
    if (static_cast<double>(fresh) < std::max(2.0, kNew * static_cast<double>(thing.points.size()))) continue;
    double nearest = kFastest * elapsed;
    Point velocity;
    for (const Thing& old : before->things) {
      const double dx = thing.middle.x - old.middle.x, dy = thing.middle.y - old.middle.y;
      if (std::hypot(dx, dy) >= nearest) continue;
      nearest = std::hypot(dx, dy);
      velocity = {dx / elapsed, dy / elapsed};
    }
    if (std::hypot(velocity.x, velocity.y) > kSlowest) movers.push_back({thing.points, velocity});
  }
  views_.push_back({scan, sensor, now, things});
  return movers;
}

std::vector<Point> placed(std::vector<Point> points, const PlanarPose& base) {
  for (Point& point : points) {
    const PlanarPose at = composed(base, {point.x, point.y, 0});
    point = {at.x, at.y};
  }
  return points;
}

std::vector<Mover> movers_seen_from(std::vector<Mover> movers, const PlanarPose& base) {
  const double c = std::cos(base.yaw), s = std::sin(base.yaw);
  const auto turned = [&](double x, double y) { return Point{c * x + s * y, c * y - s * x}; };
  for (Mover& mover : movers) {
    for (Point& point : mover.points) point = turned(point.x - base.x, point.y - base.y);
    mover.velocity = turned(mover.velocity.x, mover.velocity.y);
  }
  return movers;
}

std::vector<Point> places_ahead(const std::vector<Mover>& movers, const Footprint& footprint) {
  std::vector<Point> places;
  for (const Mover& mover : movers) {
    std::vector<Point> own;
    for (double time = 0; time <= kForesight; time += kTick) {
      for (const Point point : mover.points)
        own.push_back({point.x + mover.velocity.x * time, point.y + mover.velocity.y * time});
    }
    if (std::ranges::any_of(own, [&](Point place) { return footprint.distance(place) < kTouching; })) continue;
    places.insert(places.end(), own.begin(), own.end());
  }
  return places;
}

}  // namespace robot_control
