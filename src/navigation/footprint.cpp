#include "navigation/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "machine/bodies/shape_support.h"

namespace robot_control::navigation {

double Footprint::distance(Point point) const noexcept {
  double farthest = -circumscribed;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point a = corners[i], b = corners[(i + 1) % corners.size()];
    const double cross = (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x);
    farthest = std::max(farthest, -cross / std::hypot(b.x - a.x, b.y - a.y));
  }
  return farthest;
}

Footprint footprint_of(const std::function<double(Point)>& reach) {
  constexpr double kSame = 1e-6;  // m
  std::array<Point, 64> normals;
  std::array<double, 64> reaches;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(normals.size());
    normals[i] = {std::cos(angle), std::sin(angle)};
    reaches[i] = reach(normals[i]);
  }
  Footprint result;
  result.inscribed = *std::ranges::min_element(reaches);
  if (!(result.inscribed > 0))
    throw std::invalid_argument("the footprint of the robot does not contain the origin of its base link");
  const auto corner = [&](std::size_t i) {  // where this tangent meets the next one
    const std::size_t next = (i + 1) % normals.size();
    const Point a = normals[i], b = normals[next];
    const double sine = a.x * b.y - a.y * b.x;
    return Point{(reaches[i] * b.y - reaches[next] * a.y) / sine, (reaches[next] * a.x - reaches[i] * b.x) / sine};
  };
  Point last = corner(normals.size() - 1);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Point at = corner(i);
    if (std::hypot(at.x - last.x, at.y - last.y) > kSame) result.corners.push_back(at);
    last = at;
    result.circumscribed = std::max(result.circumscribed, std::hypot(at.x, at.y));
    result.half_width = std::max(result.half_width, std::abs(at.y));
  }
  return result;
}

Footprint footprint_of(const RigidBodies& robot) {
  return footprint_of([&](Point normal) {
    double reach = -std::numeric_limits<double>::infinity();
    for (const RigidBody& body : robot.bodies) {
      const Eigen::Vector3d along(normal.x, normal.y, 0);
      const double base = body.in_root.translation().dot(along);
      for (const Shape& shape : body.shapes)
        reach = std::max(reach, base + support(shape, body.in_root.linear().transpose() * along));
    }
    return reach;
  });
}

Footprint hull_of(const std::vector<Footprint>& outlines) {
  return footprint_of([&](Point normal) {
    double reach = -std::numeric_limits<double>::infinity();
    for (const Footprint& outline : outlines) {
      for (const Point corner : outline.corners) reach = std::max(reach, corner.x * normal.x + corner.y * normal.y);
    }
    return reach;
  });
}

}  // namespace robot_control::navigation
