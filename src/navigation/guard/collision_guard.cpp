#include "navigation/guard/collision_guard.h"

#include <algorithm>
#include <cmath>

namespace robot_control::navigation {

void CollisionGuard::insert(const std::string& laser, const Scan& scan, const PlanarPose& mount, const PlanarPose& base,
                            double stamp) {
  Laser& seen = lasers_[laser];
  seen.memory.update(scan, mount, base, stamp, footprint_);
  seen.objects = seen.moving.update(scan, composed(base, mount), stamp);
  seen.stamp = stamp;
}

GuardVerdict CollisionGuard::check(const PlanarPose& base, const PlanarMotion& measured, const PlanarMotion& requested,
                                   double now) const {
  std::vector<Point> points;
  std::vector<MovingObject> objects;
  for (const auto& [name, laser] : lasers_) {
    if (!laser.memory.problem().empty()) return {.clearance = 0, .problem = laser.memory.problem(), .obstacle = {}};
    points.insert(points.end(), laser.memory.points().begin(), laser.memory.points().end());
    for (MovingObject object : laser.objects) {
      for (Point& point : object.points) {
        point.x += object.velocity.x * (now - laser.stamp);
        point.y += object.velocity.y * (now - laser.stamp);
      }
      objects.push_back(std::move(object));
    }
  }
  points = composed(inverse(base), std::move(points));
  objects = composed(inverse(base), std::move(objects));
  const auto speed = [&](const PlanarMotion& motion) {
    return std::hypot(motion.linear, motion.lateral) + std::abs(motion.angular) * footprint_.circumscribed;
  };
  std::vector<PlanarMotion> motions;
  if (speed(measured) > kMovingSpeed) motions.push_back(measured);
  if (speed(requested) > 0 || motions.empty()) motions.push_back(requested);
  GuardVerdict verdict{.clearance = kLookAhead, .problem = {}, .obstacle = {}};
  for (const PlanarMotion& motion : motions) {
    const FreeWay free = free_way(footprint_, points, motion, objects);
    if (free.distance < verdict.clearance) verdict.clearance = free.distance, verdict.obstacle = free.obstacle;
  }
  return verdict;
}

}  // namespace robot_control::navigation
