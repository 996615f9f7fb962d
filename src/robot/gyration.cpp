#include "robot/gyration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "robot/wording.h"

namespace robot_control {
namespace {

double extent(const Shape& shape) {
  if (shape.type == ShapeType::kSphere) return 2 * shape.radius;
  if (shape.type == ShapeType::kCylinder) return std::hypot(2 * shape.radius, shape.length);
  if (shape.type == ShapeType::kBox) return shape.size.norm();
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : shape.points) box.extend(point);
  return box.sizes().norm();
}

}  // namespace

void note_gyration(const urdf::Link& link, const std::vector<Shape>& shapes, std::vector<RobotNote>& notes) {
  if (!link.inertial || !(link.inertial->mass > 0) || shapes.empty()) return;
  const urdf::Inertial& given = *link.inertial;
  Eigen::Matrix3d tensor;
  tensor << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz, given.iyz, given.izz;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor, Eigen::EigenvaluesOnly);
  const double gyration = std::sqrt(std::max(0.0, solver.eigenvalues()[2] / given.mass));
  double largest = 0;
  for (const Shape& shape : shapes) largest = std::max(largest, extent(shape));
  if (gyration <= largest) return;
  notes.push_back({RobotNote::Kind::kSuspicious, link_element(link.name),
                   "its radius of gyration is " + number(gyration) + " m, the part itself measures " + number(largest) +
                       " m: inertia too large for " + number(given.mass) + " kg"});
}

}  // namespace robot_control
