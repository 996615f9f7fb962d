#include "machine/bodies/shape_points.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

constexpr int kRimPoints = 16;

/// Returns the support point of the ellipsoid towards −z.
Eigen::Vector3d lowest(const RollingEllipsoid& wheel, const Eigen::Vector3d& axle) {
  const double half_width = wheel.width / 2;
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  const double along = axle.dot(down);
  const Eigen::Vector3d across = down - along * axle;
  const Eigen::Vector3d scaled = wheel.radius * wheel.radius * across + half_width * half_width * along * axle;
  const double support = std::sqrt(down.dot(scaled));
  return Eigen::Vector3d(wheel.centre_base[0], wheel.centre_base[1], wheel.centre_base[2]) + scaled / support;
}

void add_cylinder(const Shape& shape, const Eigen::Isometry3d& in_base, std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d down = in_base.linear().transpose() * -Eigen::Vector3d::UnitZ();
  const double lowest_angle = std::atan2(down.y(), down.x());
  for (int i = 0; i < kRimPoints; ++i) {
    const double angle = lowest_angle + 2 * M_PI * i / kRimPoints;
    const Eigen::Vector3d rim(shape.radius * std::cos(angle), shape.radius * std::sin(angle), 0);
    for (const double end : {-0.5, 0.5})
      points.push_back(in_base * (rim + end * shape.length * Eigen::Vector3d::UnitZ()));
  }
}

void add_shape(const Shape& shape, const Eigen::Isometry3d& in_base, std::vector<Eigen::Vector3d>& points) {
  switch (shape.type) {
    case ShapeType::kSphere:
      points.push_back(in_base.translation() - shape.radius * Eigen::Vector3d::UnitZ());
      break;
    case ShapeType::kCylinder:
      add_cylinder(shape, in_base, points);
      break;
    case ShapeType::kBox:
      for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d sign((corner & 1) ? 0.5 : -0.5, (corner & 2) ? 0.5 : -0.5, (corner & 4) ? 0.5 : -0.5);
        points.push_back(in_base * sign.cwiseProduct(shape.size));
      }
      break;
    case ShapeType::kMesh:
      for (const Eigen::Vector3d& point : shape.points) points.push_back(in_base * point);
      break;
  }
}

}  // namespace

std::vector<Eigen::Vector3d> shape_points(const RigidBody& body, const RollingEllipsoid* rolling) {
  if (rolling != nullptr) return {lowest(*rolling, body.in_root.linear() * body.joint.axis)};
  std::vector<Eigen::Vector3d> points;
  for (const Shape& shape : body.shapes) add_shape(shape, body.in_root * shape.in_body, points);
  return points;
}

double height_above(const std::vector<Eigen::Vector3d>& points) {
  return -(*std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
            return a.z() < b.z();
          })).z();
}

}  // namespace robot_control
