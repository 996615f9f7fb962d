#include "navigation/guard/scan_memory.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "signals/formatted_text.h"

namespace robot_control::navigation {
namespace {

constexpr double kMinPassing = 0.1;  // m by which a ray has to pass a point
constexpr double kMaxGap = 0.25;     // m between the ends of neighbouring rays on one surface
constexpr double kDegrees = 180 / M_PI;
constexpr double kSway = 0.05;  // m: a base that moves less stands
constexpr double kJump = 0.5;   // m, rad beyond kMaxObjectSpeed

bool echo(const Scan& scan, std::size_t ray) {
  return scan.hit(scan.ranges[ray]);
}

double distance(Point a, Point b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// Returns the direction of the point in rays from the first one; it may lie between two, or beyond the last.
double ray_towards(const Scan& scan, const PlanarPose& sensor, Point at) {
  const double offset = std::atan2(at.y - sensor.y, at.x - sensor.x) - sensor.yaw - scan.angle_min;
  const double ray = offset / scan.angle_increment, turn = 2 * M_PI / std::abs(scan.angle_increment);
  return ray - std::floor(ray / turn) * turn;
}

bool in_view(const Scan& scan, const PlanarPose& sensor, Point at) {
  const double range = distance({sensor.x, sensor.y}, at);
  return ray_towards(scan, sensor, at) <= static_cast<double>(scan.ranges.size() - 1) && range >= scan.range_min &&
         range <= kSureEcho * scan.range_max;
}

}  // namespace

ScanMemory::Fate ScanMemory::fate_of(const Memory& memory, const Scan& scan, const PlanarPose& sensor,
                                     double stamp) const {
  if (!in_view(scan, sensor, memory.at)) {
    if (memory.vanished && blind_) return Fate::kVanished;
    return driven_ - memory.driven <= kLookAhead ? Fate::kKept : Fate::kForgotten;
  }
  const bool recent = stamp - memory.seen <= kRecall;
  const Fate hidden = recent ? Fate::kKept : Fate::kForgotten;
  const Fate aged = memory.vanished && (recent || blind_) ? Fate::kVanished : hidden;
  const double ray = ray_towards(scan, sensor, memory.at), range = distance({sensor.x, sensor.y}, memory.at);
  const auto rays = static_cast<double>(scan.ranges.size());
  int behind = 0, silent = 0;
  for (const double side : {std::floor(ray), std::ceil(ray)}) {
    const auto i = static_cast<std::size_t>(side);
    if (!echo(scan, i)) {
      ++silent;
    } else if (std::abs(scan.ranges[i] - range) <= kMinPassing) {
      return Fate::kForgotten;
    } else {
      behind += scan.ranges[i] > range ? 1 : 0;
    }
  }
  if (behind == 2) return Fate::kForgotten;
  if (silent == 0) return hidden;
  if (memory.vanished) return aged;
  const double moved = kMinPassing + kMaxObjectSpeed * (stamp - memory.seen);
  const double window = (moved < range ? std::asin(moved / range) : M_PI) / std::abs(scan.angle_increment);
  const double turn = 2 * M_PI / std::abs(scan.angle_increment);
  for (const double middle : {ray - turn, ray, ray + turn}) {
    for (double i = std::max(0.0, std::ceil(middle - window)); i <= std::min(rays - 1, middle + window); ++i) {
      const auto near = static_cast<std::size_t>(i);
      if (echo(scan, near) && distance(end_of(scan, sensor, near), memory.at) <= moved) return aged;
    }
  }
  return Fate::kVanished;
}

double ScanMemory::frozen_angle(const Scan& scan, const PlanarPose& sensor) const {
  if (reference_.ranges.size() != scan.ranges.size()) return 0;
  std::vector<bool> frozen(scan.ranges.size());
  Point last;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    if (!echo(reference_, i)) continue;
    const Point end = end_of(reference_, reference_sensor_, i);
    if (i > 0 && echo(reference_, i - 1) && distance(end, last) < kMaxGap) {
      const double turn = 2 * M_PI / std::abs(scan.angle_increment), from = ray_towards(scan, sensor, last);
      const double span = std::remainder(ray_towards(scan, sensor, end) - from, turn);
      for (double ray = std::ceil(from); span > 0 && ray < std::min(from + span, static_cast<double>(frozen.size()));
           ++ray) {
        const auto k = static_cast<std::size_t>(ray);
        const double share = (ray - from) / span;
        const Point at{last.x + share * (end.x - last.x), last.y + share * (end.y - last.y)};
        const double expected = distance(at, {sensor.x, sensor.y});
        frozen[k] = echo(scan, k) && scan.ranges[k] == reference_.ranges[k] &&
                    std::abs(scan.ranges[k] - expected) > kFrozenRange;
      }
    }
    last = end;
  }
  return static_cast<double>(std::count(frozen.begin(), frozen.end(), true)) * std::abs(scan.angle_increment);
}

void ScanMemory::update(const Scan& scan, const PlanarPose& mount, const PlanarPose& base, double stamp,
                        const Footprint& footprint) {
  const double elapsed = stamp - stamp_, allowed = kJump + kMaxObjectSpeed * elapsed;
  const double turned = std::abs(std::remainder(base.yaw - base_.yaw, 2 * M_PI));
  const double moved = distance({base.x, base.y}, {base_.x, base_.y});
  if (!(elapsed >= 0 && elapsed <= kRecall) || moved > allowed || turned > allowed) *this = ScanMemory();
  stamp_ = stamp, base_ = base;
  const double passed = distance({base.x, base.y}, counted_);
  if (passed > kSway) driven_ += passed, counted_ = {base.x, base.y};
  const PlanarPose sensor = composed(base, mount);
  std::vector<bool> vanished(360);  // degrees
  std::erase_if(memories_, [&](Memory& memory) {
    const Fate fate = fate_of(memory, scan, sensor, stamp);
    memory.vanished = fate == Fate::kVanished;
    const double direction = std::atan2(memory.at.y - sensor.y, memory.at.x - sensor.x) * kDegrees;
    if (memory.vanished) vanished[static_cast<std::size_t>(direction + 359.5) % 360] = true;
    return fate == Fate::kForgotten;
  });
  const auto blind = std::count(vanished.begin(), vanished.end(), true);
  blind_ = static_cast<double>(blind) > kDegrees * kDoubtfulAngle;
  points_.clear();
  Scan world = scan;  // without the parts of the robot
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const bool own = echo(scan, i) && footprint.distance(end_of(scan, mount, i)) < -kLaserNoise;
    if (own) world.ranges[i] = std::numeric_limits<float>::infinity();
    if (!echo(world, i)) continue;
    const Point end = end_of(scan, sensor, i);
    if (!in_view(scan, sensor, end)) {
      points_.push_back(end);
    } else if (!blind_) {
      memories_.push_back({.at = end, .seen = stamp, .driven = driven_});
    }
  }
  for (const Memory& memory : memories_) points_.push_back(memory.at);
  problem_.clear();
  const double since = distance({sensor.x, sensor.y}, {reference_sensor_.x, reference_sensor_.y}) +
                       std::abs(std::remainder(sensor.yaw - reference_sensor_.yaw, 2 * M_PI));
  if (reference_.ranges.empty() || since > kFrozenMotion) {
    const double frozen = frozen_angle(world, sensor);
    if (frozen > kDoubtfulAngle) {
      problem_ =
          formatted("scan is frozen in part: %.0f degrees of it stay the same while the robot moves: check the laser",
                    kDegrees * frozen);
    } else {
      reference_ = std::move(world), reference_sensor_ = sensor;
    }
  }
  if (blind_)
    problem_ =
        formatted("scan is blind in part: no echo over %ld degrees where obstacles were: check the laser", blind);
}

}  // namespace robot_control::navigation
