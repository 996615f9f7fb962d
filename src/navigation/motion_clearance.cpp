#include "navigation/motion_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control::navigation {
namespace {

constexpr double kStep = 0.02;          // m of the path of the outline's widest point
constexpr double kMinApproach = 0.001;  // m
constexpr double kOnTheSpot = 0.02;     // m/s; a slower base turns on the spot, if it turns
constexpr double kMinBaseSpeed = 0.1;   // m/s, for the time in which the base meets a moving object

struct WatchedPoint {
  Point point;
  double at_start;  // m from the outline
  Point velocity;   // m/s
  double until;     // s, for which the velocity is predicted
};

}  // namespace

double clearance_along(const Footprint& footprint, const std::vector<Point>& points, const PlanarMotion& motion,
                       const std::vector<MovingObject>& objects) {
  const bool spot = std::abs(motion.linear) < kOnTheSpot && motion.angular != 0;
  const double reach = footprint.circumscribed + kLaserNoise + (spot ? 0 : kLookAhead);
  std::vector<WatchedPoint> watched;
  const auto watch = [&](Point point, Point velocity, double until) {
    const double distance = footprint.distance(point);
    const double approach = std::isfinite(until) ? std::hypot(velocity.x, velocity.y) * until : 0;
    if (distance > 0 && std::hypot(point.x, point.y) <= reach + approach) {
      watched.push_back({point, distance, velocity, until});
    }
  };
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  for (const Point point : points) watch(point, {}, kUnlimited);
  for (const MovingObject& object : objects) {
    for (const Point point : object.points) watch(point, object.velocity, kPredictionTime);
  }
  const double sign = std::copysign(1.0, spot ? motion.angular : motion.linear);
  const double turn = spot                 ? sign / footprint.half_width  // rad per m
                      : motion.linear != 0 ? motion.angular / std::abs(motion.linear)
                                           : 0;
  const double end = spot ? 2 * M_PI * footprint.half_width : kLookAhead;
  const double speed =
      std::max(kMinBaseSpeed, spot ? std::abs(motion.angular) * footprint.half_width : std::abs(motion.linear));
  for (double along = kStep; along < end; along += kStep) {
    const double yaw = turn * along, half = yaw / 2;
    const double chord = spot ? 0 : sign * along * (std::abs(half) < 1e-9 ? 1 : std::sin(half) / half);
    const double x = chord * std::cos(half), y = chord * std::sin(half), c = std::cos(yaw), s = std::sin(yaw);
    for (const auto& [point, at_start, velocity, until] : watched) {
      const double time = along / speed;
      if (time > until) continue;
      const double dx = point.x + velocity.x * time - x, dy = point.y + velocity.y * time - y;
      const double distance = footprint.distance({c * dx + s * dy, c * dy - s * dx});
      if (distance < kLaserNoise && distance < at_start - kMinApproach)
        return std::max(0.0, along - kStep - kRemainingGap);
    }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace robot_control::navigation
