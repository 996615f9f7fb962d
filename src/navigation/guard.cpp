#include "navigation/guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control {
namespace {

constexpr double kStep = 0.02;       // m of the way of the outline's widest place
constexpr double kNearer = 0.001;    // m
constexpr double kOnTheSpot = 0.02;  // m/s; a slower base turns on the spot, if it turns

struct Watched {
  Point point;
  double at_start;  // m from the outline
};

}  // namespace

double free_way(const Footprint& footprint, const std::vector<Point>& points, const PlanarMotion& motion) {
  const bool spot = std::abs(motion.linear) < kOnTheSpot && motion.angular != 0;
  const double reach = footprint.circumscribed + kBeside + (spot ? 0 : kLookout);
  std::vector<Watched> watched;
  for (const Point point : points) {
    const double distance = footprint.distance(point);
    if (distance > 0 && std::hypot(point.x, point.y) <= reach) watched.push_back({point, distance});
  }
  const double sign = std::copysign(1.0, spot ? motion.angular : motion.linear);
  const double turn = spot                 ? sign / footprint.half_width  // rad per m
                      : motion.linear != 0 ? motion.angular / std::abs(motion.linear)
                                           : 0;
  const double end = spot ? 2 * M_PI * footprint.half_width : kLookout;
  for (double along = kStep; along < end; along += kStep) {
    const double yaw = turn * along, half = yaw / 2;
    const double chord = spot ? 0 : sign * along * (std::abs(half) < 1e-9 ? 1 : std::sin(half) / half);
    const double x = chord * std::cos(half), y = chord * std::sin(half), c = std::cos(yaw), s = std::sin(yaw);
    for (const auto& [point, at_start] : watched) {
      const double dx = point.x - x, dy = point.y - y;
      const double distance = footprint.distance({c * dx + s * dy, c * dy - s * dx});
      if (distance < kBeside && distance < at_start - kNearer) return std::max(0.0, along - kStep - kStopShort);
    }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace robot_control
