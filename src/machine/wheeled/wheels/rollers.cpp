#include "machine/wheeled/wheels/rollers.h"

#include <algorithm>
#include <cmath>

#include "machine/bodies/shape_support.h"

namespace robot_control {
namespace {

constexpr double kMaxAlongAxle = 0.985;  // cos 10°
constexpr double kMaxOutwards = 0.5;     // cos 60°
constexpr double kMinOffsetShare = 0.5;  // share of the reach
constexpr double kMinReachShare = 0.9;

double distance(const Eigen::Vector3d& point, const Eigen::Vector3d& axle) {
  return point.cross(axle).norm();
}

double farthest(const RigidBody& body) {
  double reach = 0;
  for (const Shape& shape : body.shapes) {
    const Eigen::Vector3d& axle = body.joint.axis;
    const Eigen::Vector3d centre = shape.in_body.translation();
    if (shape.type == ShapeType::kMesh) {
      for (const Eigen::Vector3d& point : shape.points) reach = std::max(reach, distance(shape.in_body * point, axle));
      continue;
    }
    const Eigen::Vector3d outwards = centre - centre.dot(axle) * axle;
    const Eigen::Vector3d u = outwards.norm() > 1e-9 ? outwards.normalized() : axle.unitOrthogonal();
    reach = std::max(reach, support(shape, u));
  }
  return reach;
}

bool is_roller(const Shape& shape, const Eigen::Vector3d& axle, double reach) {
  if (shape.type != ShapeType::kCylinder) return false;
  const Eigen::Vector3d along = shape.in_body.linear().col(2);
  const Eigen::Vector3d centre = shape.in_body.translation();
  const Eigen::Vector3d outwards = (centre - centre.dot(axle) * axle).normalized();
  return std::abs(along.dot(axle)) < kMaxAlongAxle && distance(centre, axle) > kMinOffsetShare * reach &&
         std::abs(along.dot(outwards)) < kMaxOutwards && support(shape, outwards) > kMinReachShare * reach;
}

}  // namespace

std::size_t rollers_of(const RigidBodies& robot, std::size_t index) {
  const RigidBody& body = robot.bodies[index];
  if (index == 0 || body.joint.type == JointType::kPrismatic) return 0;
  const Eigen::Vector3d& axle = body.joint.axis;
  const double reach = farthest(body);
  std::size_t rollers = 0;
  for (const Shape& shape : body.shapes) rollers += is_roller(shape, axle, reach);
  for (std::size_t i = index + 1; i < robot.bodies.size(); ++i) {
    const RigidBody& child = robot.bodies[i];
    if (child.parent != index || child.joint.type == JointType::kPrismatic) continue;
    const Eigen::Isometry3d in_body = body.in_root.inverse() * child.in_root;
    const Eigen::Vector3d axis = in_body.linear() * child.joint.axis;
    rollers +=
        std::abs(axis.dot(axle)) < kMaxAlongAxle && distance(in_body.translation(), axle) > kMinOffsetShare * reach;
  }
  return rollers < kMinRollers ? 0 : rollers;
}

std::string rollers_objection(std::size_t rollers) {
  return "its rim is " + std::to_string(rollers) +
         " rollers, as on an omni or mecanum wheel: it also rolls sideways, and only plain wheels are supported "
         "here";
}

}  // namespace robot_control
