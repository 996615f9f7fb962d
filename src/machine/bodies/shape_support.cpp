#include "machine/bodies/shape_support.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control {

double support(const Shape& shape, const Eigen::Vector3d& u) {
  const Eigen::Vector3d local = shape.in_body.linear().transpose() * u;
  const double centre = shape.in_body.translation().dot(u);
  switch (shape.type) {
    case ShapeType::kSphere:
      return centre + shape.radius;
    case ShapeType::kCylinder:
      return centre + shape.radius * local.head<2>().norm() + shape.length / 2 * std::abs(local.z());
    case ShapeType::kBox:
      return centre + shape.size.dot(local.cwiseAbs()) / 2;
    case ShapeType::kMesh:
      break;
  }
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : shape.points) farthest = std::max(farthest, point.dot(local));
  return centre + farthest;
}

Eigen::AlignedBox3d box_of(const RigidBody& body, const Shape& shape) {
  Eigen::AlignedBox3d box;
  Eigen::Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d u = body.in_root.linear().transpose() * Eigen::Vector3d::Unit(axis);
    low[axis] = body.in_root.translation()[axis] - support(shape, -u);
    high[axis] = body.in_root.translation()[axis] + support(shape, u);
  }
  box.extend(low);
  box.extend(high);
  return box;
}

}  // namespace robot_control
