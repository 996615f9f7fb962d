#include "navigation/footprint.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {
namespace {

double cross(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Adds the lower half of the hull of sorted points (A. M. Andrew, 1979).
template <class Iterator>
void append_chain(Iterator begin, Iterator end, std::vector<Point>& hull) {
  const std::size_t first = hull.size();
  for (Iterator point = begin; point != end; ++point) {
    while (hull.size() >= first + 2 && cross(hull[hull.size() - 2], hull.back(), *point) <= 0) hull.pop_back();
    hull.push_back(*point);
  }
  hull.pop_back();
}

void append_shape(const Shape& shape, const Eigen::Isometry3d& in_root, std::vector<Point>& points) {
  const auto add = [&](double x, double y, double z) {
    const Eigen::Vector3d point = in_root * Eigen::Vector3d(x, y, z);
    points.push_back({point.x(), point.y()});
  };
  constexpr int kCircle = 32;  // corners; the outline lies inside a circle by 0.5 % of its radius
  for (int i = 0; i < kCircle; ++i) {
    const double angle = 2 * M_PI * i / kCircle, c = std::cos(angle) * shape.radius, s = std::sin(angle) * shape.radius;
    if (shape.type == ShapeType::kCylinder) add(c, s, shape.length / 2), add(c, s, -shape.length / 2);
    if (shape.type != ShapeType::kSphere) continue;
    const Eigen::Vector3d middle = in_root.translation();
    points.push_back({middle.x() + c, middle.y() + s});
  }
  const Eigen::Vector3d half = shape.size / 2;
  for (int corner = 0; shape.type == ShapeType::kBox && corner < 8; ++corner) {
    add((corner & 1) != 0 ? half.x() : -half.x(), (corner & 2) != 0 ? half.y() : -half.y(),
        (corner & 4) != 0 ? half.z() : -half.z());
  }
  for (const Eigen::Vector3d& point : shape.points) add(point.x(), point.y(), point.z());
}

}  // namespace

double Footprint::distance(Point point) const noexcept {
  double farthest = -circumscribed;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point a = corners[i], b = corners[(i + 1) % corners.size()];
    farthest = std::max(farthest, -cross(a, b, point) / std::hypot(b.x - a.x, b.y - a.y));
  }
  return farthest;
}

Footprint footprint_of(std::vector<Point> points) {
  std::sort(points.begin(), points.end(), [](Point a, Point b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  Footprint result;
  if (points.size() >= 3) {
    append_chain(points.begin(), points.end(), result.corners);
    append_chain(points.rbegin(), points.rend(), result.corners);
  }
  for (const Point corner : result.corners) {
    result.circumscribed = std::max(result.circumscribed, std::hypot(corner.x, corner.y));
    result.half_width = std::max(result.half_width, std::abs(corner.y));
  }
  result.inscribed = -result.distance({});
  if (result.corners.size() < 3 || !(result.inscribed > 0)) {
    throw std::invalid_argument("the outline of the robot's shapes does not hold the origin of its base link");
  }
  return result;
}

Footprint footprint_of_urdf(const std::string& urdf, const std::string& source) {
  const RigidBodies robot = read_rigid_bodies({urdf, source});
  std::vector<Point> points;
  for (const RigidBody& body : robot.bodies) {
    for (const Shape& shape : body.shapes) append_shape(shape, body.in_root * shape.in_body, points);
  }
  return footprint_of(std::move(points));
}

}  // namespace robot_control
