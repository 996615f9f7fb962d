#include "machine/wheeled/wheels/swivel.h"

#include <cmath>

namespace robot_control {
namespace {

constexpr double kUpright = 0.8;           // |z| of a swivel's axis: within 37° of the vertical
constexpr double kWholeTurn = 1.9 * M_PI;  // rad: drawings stop a caster at ±π

}  // namespace

bool is_swivel(const RigidBody& body) {
  return body.joint.type != JointType::kPrismatic && std::abs((body.in_root.linear() * body.joint.axis).z()) > kUpright;
}

const RigidBody* swivel_of(const RigidBodies& robot, std::size_t body) {
  for (std::size_t i = robot.bodies[body].parent; i != 0; i = robot.bodies[i].parent) {
    if (is_swivel(robot.bodies[i])) return &robot.bodies[i];
  }
  return nullptr;
}

bool trails(const RigidBody& swivel, const RollingMeasure& wheel) {
  const Eigen::Vector3d axis = swivel.in_root.linear() * swivel.joint.axis;
  const Eigen::Vector3d rolling = wheel.axle_in_root.cross(axis).normalized();
  const Eigen::Vector3d centre(wheel.centre_base[0], wheel.centre_base[1], wheel.centre_base[2]);
  const double trail = std::abs((centre - swivel.in_root.translation()).dot(rolling));
  return trail >= kMinTrail * wheel.radius;
}

bool is_steered(const RigidBody& swivel, const RigidBody& body, const RollingMeasure& wheel) {
  const BodyJoint& joint = swivel.joint;
  const bool ends = joint.lower < joint.upper && joint.upper - joint.lower < kWholeTurn;
  return !trails(swivel, wheel) && (ends || joint.driven || body.joint.driven || !joint.mimicked.empty());
}

}  // namespace robot_control
