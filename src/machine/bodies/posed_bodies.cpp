#include "machine/bodies/posed_bodies.h"

namespace robot_control {

RigidBodies posed(const RigidBodies& bodies, const std::map<std::string, double>& positions) {
  RigidBodies result = bodies;
  for (std::size_t i = 1; i < bodies.bodies.size(); ++i) {
    const RigidBody& body = bodies.bodies[i];
    const auto found = positions.find(body.joint.name);
    const double position = found == positions.end() ? 0 : found->second;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    if (body.joint.type == JointType::kPrismatic) {
      motion.translation() = position * body.joint.axis;
    } else {
      motion.linear() = Eigen::AngleAxisd(position, body.joint.axis).toRotationMatrix();
    }
    const Eigen::Isometry3d in_parent = bodies.bodies[body.parent].in_root.inverse() * body.in_root;
    result.bodies[i].in_root = result.bodies[body.parent].in_root * in_parent * motion;
  }
  return result;
}

RigidBodies resting(const RigidBodies& bodies, std::span<const JointModel> joints) {
  std::map<std::string, double> positions;
  for (const JointModel& joint : joints) {
    if (joint.rest_position != 0) positions[joint.name] = joint.rest_position;
  }
  return positions.empty() ? bodies : posed(bodies, positions);
}

}  // namespace robot_control
