#include "machine/bodies/gravity_load.h"

#include <cmath>

#include "machine/gravity.h"

namespace robot_control {

bool is_carried(const RigidBodies& bodies, std::size_t body, std::size_t carrier) {
  while (body > carrier) body = bodies.bodies[body].parent;
  return body == carrier;
}

double gravity_load(const RigidBodies& bodies, std::size_t body) {
  const RigidBody& moved = bodies.bodies[body];
  const Eigen::Vector3d axis = moved.in_root.linear() * moved.joint.axis;
  double load = 0;
  for (std::size_t i = body; i < bodies.bodies.size(); ++i) {
    if (!is_carried(bodies, i, body)) continue;
    const RigidBody& carried = bodies.bodies[i];
    const Eigen::Vector3d weight = -carried.mass * kGravity * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d arm = carried.in_root * carried.centre_of_gravity - moved.in_root.translation();
    load += axis.dot(moved.joint.type == JointType::kPrismatic ? weight : arm.cross(weight));
  }
  return std::abs(load);
}

}  // namespace robot_control
