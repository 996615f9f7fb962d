#include "machine/joint_roles.h"

namespace robot_control {

std::vector<JointRole> joint_roles(const RigidBodies& robot, const DriveTrain& train) {
  std::vector<JointRole> roles(robot.bodies.size(), JointRole::kHeld);
  for (std::size_t i = 1; i < robot.bodies.size(); ++i) {
    const BodyJoint& joint = robot.bodies[i].joint;
    if (!joint.mimicked.empty() || !(joint.effort_limit > 0)) roles[i] = JointRole::kPassive;
  }
  for (const auto* rolling : {&train.wheels, &train.casters}) {
    for (const RollingBody& wheel : *rolling) {
      for (std::size_t i = wheel.body; i != 0; i = robot.bodies[i].parent) roles[i] = JointRole::kPassive;
    }
  }
  for (const RollingBody& wheel : train.wheels) roles[wheel.body] = JointRole::kWheel;
  return roles;
}

}  // namespace robot_control
