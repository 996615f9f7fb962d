#include "machine/bodies/gyration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "machine/bodies/link_inertia.h"
#include "machine/description/wording.h"

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

double gyration_radius(const urdf::Link& link) {
  if (!link.inertial || !(link.inertial->mass > 0)) return 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(eigen_inertia(*link.inertial), Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2] / link.inertial->mass));
}

double robot_size(const RigidBodies& robot) {
  Eigen::AlignedBox3d box;
  bool shaped = false;
  for (const auto& [name, place] : robot.links) {
    box.extend((robot.bodies[place.body].in_root * place.in_body).translation());
  }
  for (const RigidBody& body : robot.bodies) {
    for (const Shape& shape : body.shapes) {
      shaped = true;
      const Eigen::Isometry3d in_root = body.in_root * shape.in_body;
      for (const Eigen::Vector3d& point : shape.points) box.extend(in_root * point);
      if (shape.type == ShapeType::kMesh) continue;
      const Eigen::Vector3d half = Eigen::Vector3d::Constant(extent(shape) / 2);
      box.extend(in_root.translation() + half);
      box.extend(in_root.translation() - half);
    }
  }
  return shaped ? box.sizes().norm() : std::numeric_limits<double>::infinity();
}

void note_gyration(const urdf::Link& link, const std::vector<Shape>& shapes, std::vector<RobotNote>& notes) {
  if (shapes.empty()) return;
  const double gyration = gyration_radius(link);
  double largest = 0;
  for (const Shape& shape : shapes) largest = std::max(largest, extent(shape));
  if (gyration <= largest) return;
  notes.push_back({RobotNote::Kind::kSuspicious, link_element(link.name),
                   "its radius of gyration is " + number(gyration) + " m, but the size of the part is " +
                       number(largest) + " m: inertia too large for " + number(link.inertial->mass) + " kg"});
}

}  // namespace robot_control
