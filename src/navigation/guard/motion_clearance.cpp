#include "navigation/guard/motion_clearance.h"

#include <algorithm>
#include <cmath>

namespace robot_control::navigation {
namespace {

constexpr double kStep = 0.02;          // m of the path of the outline's widest point
constexpr double kMinApproach = 0.001;  // m
constexpr double kOnTheSpot = 0.02;     // m/s; a slower base turns on the spot, if it turns
constexpr double kMinBaseSpeed = 0.1;   // m/s, for the time in which the base meets a moving object

/// The arc of a motion: the base goes along `course` and turns by `turn` per m.
struct Arc {
  Point course;        // unit vector in base axes; zero on the spot
  double turn = 0;     // rad/m
  double end = 0;      // m
  double speed = 0;    // m/s
  double fastest = 0;  // m of the outline's fastest point per m along
};

Arc arc_of(const Footprint& footprint, const PlanarMotion& motion) {
  const double speed = std::hypot(motion.linear, motion.lateral);
  Arc arc;
  if (speed < kOnTheSpot && motion.angular != 0) {
    arc.turn = std::copysign(1 / footprint.half_width, motion.angular);
    arc.end = 2 * M_PI * footprint.half_width;
    arc.speed = std::abs(motion.angular) * footprint.half_width;
  } else {
    arc.course = speed > 0 ? Point{motion.linear / speed, motion.lateral / speed} : Point{1, 0};
    arc.turn = speed > 0 ? motion.angular / speed : 0;
    arc.end = kLookAhead;
    arc.speed = speed;
    arc.fastest = 1;
  }
  arc.speed = std::max(kMinBaseSpeed, arc.speed);
  arc.fastest += std::abs(arc.turn) * footprint.circumscribed;
  return arc;
}

/// Returns the point, given in the axes of the base at the start, in those of the base `along` m later.
Point seen_after(const Arc& arc, double along, Point point) {
  const double yaw = arc.turn * along, half = yaw / 2;
  const double chord = along * (std::abs(half) < 1e-9 ? 1 : std::sin(half) / half);
  const double dx = point.x - chord * (arc.course.x * std::cos(half) - arc.course.y * std::sin(half));
  const double dy = point.y - chord * (arc.course.y * std::cos(half) + arc.course.x * std::sin(half));
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {c * dx + s * dy, c * dy - s * dx};
}

}  // namespace

FreeWay free_way(const Footprint& footprint, const std::vector<Point>& points, const PlanarMotion& motion,
                 const std::vector<MovingObject>& objects) {
  Arc arc = arc_of(footprint, motion);
  FreeWay free;
  const auto meet = [&](Point point, Point velocity, double until) {
    const double at_start = footprint.distance(point);
    if (at_start < -kLaserNoise) return;
    const double closing = arc.fastest + std::hypot(velocity.x, velocity.y) / arc.speed;
    for (double along = kStep; along < arc.end && along / arc.speed <= until;) {
      const double time = along / arc.speed;
      const double distance =
          footprint.distance(seen_after(arc, along, {point.x + velocity.x * time, point.y + velocity.y * time}));
      if (distance < kLaserNoise && distance < at_start - kMinApproach) {
        arc.end = along;
        free = {std::max(0.0, along - kStep - kRemainingGap), point};
        return;
      }
      along += std::max(kStep, (distance - kLaserNoise) / closing);
    }
  };
  for (const Point point : points) meet(point, {}, std::numeric_limits<double>::infinity());
  for (const MovingObject& object : objects) {
    for (const Point point : object.points) meet(point, object.velocity, kPredictionTime);
  }
  return free;
}

}  // namespace robot_control::navigation
