#include "machine/legs/leg_search.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "machine/bodies/rolling.h"
#include "machine/bodies/shape_support.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

constexpr double kSameReach = 0.005;  // m by which another shape may reach beyond a ball

bool turns_about(const RigidBody& body, Eigen::Index axis) {
  if (body.joint.type != JointType::kRevolute && body.joint.type != JointType::kContinuous) return false;
  return std::abs(axis_in_base(body)[axis]) > std::numbers::sqrt2 / 2;
}

bool begins_as_leg(const RigidBodies& robot, const BodyChain& chain) {
  bool begins = chain.bodies.size() >= kLegJoints;
  for (std::size_t i = 0; i < kLegJoints && begins; ++i)
    begins = turns_about(robot.bodies[chain.bodies[i]], leg_axis(i));
  return begins;
}

/// A ball has its own radius, and so has a cylinder across the leg.
double foot_radius(const RigidBody& body, const Shape& shape) {
  if (shape.type == ShapeType::kSphere) return shape.radius;
  if (shape.type != ShapeType::kCylinder) return 0;
  const Eigen::Vector3d axle = body.in_root.linear() * shape.in_body.linear().col(2);
  return std::abs(axle.y()) >= std::cos(kAxleTolerance) ? shape.radius : 0;
}

}  // namespace

Eigen::Vector3d axis_in_base(const RigidBody& body) {
  return body.in_root.linear() * body.joint.axis;
}

std::vector<BodyChain> leg_chains(const RigidBodies& robot) {
  std::vector<std::vector<std::size_t>> children(robot.bodies.size());
  for (std::size_t i = 1; i < robot.bodies.size(); ++i) children[robot.bodies[i].parent].push_back(i);
  std::vector<BodyChain> found;
  for (const std::size_t first : children[0]) {
    BodyChain chain{{first}};
    while (children[chain.bodies.back()].size() == 1) chain.bodies.push_back(children[chain.bodies.back()].front());
    if (begins_as_leg(robot, chain)) found.push_back(chain);
  }
  return found;
}

Foot foot_of(const RigidBodies& robot, const RigidBody& body) {
  const Shape* ball = nullptr;
  const Shape* farthest = nullptr;
  double ball_reach = 0, reach = -std::numeric_limits<double>::infinity();
  for (const Shape& shape : body.shapes) {
    const Eigen::Vector3d centre = shape.in_body.translation();
    const Eigen::Vector3d out = centre.norm() > 0 ? centre.normalized() : Eigen::Vector3d(0, 0, -1);
    const double reaches = support(shape, out);
    if (reaches > reach) {
      reach = reaches;
      farthest = &shape;
    }
    if (foot_radius(body, shape) > 0 && (ball == nullptr || reaches > ball_reach)) {
      ball_reach = reaches;
      ball = &shape;
    }
  }
  if (farthest == nullptr) {
    refuse(robot.source, link_element(body.name), "the leg that ends here has no shape that reaches the ground",
           "Give the foot a <collision>, best a sphere, on this link or on one that is fixed to it");
  }
  if (ball != nullptr && ball_reach >= reach - kSameReach)
    return {body.in_root * ball->in_body.translation(), foot_radius(body, *ball)};
  const Eigen::Vector3d centre = farthest->in_body.translation();
  const Eigen::Vector3d out = centre.norm() > 0 ? centre.normalized() : Eigen::Vector3d(0, 0, -1);
  return {body.in_root * (reach * out), 0};
}

}  // namespace robot_control
