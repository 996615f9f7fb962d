#include "machine/wheeled/joint_roles.h"

#include "machine/machine_reading.h"

namespace robot_control {

std::vector<JointRole> joint_roles(const RigidBodies& robot, const RunningGear& gear) {
  std::vector<JointRole> roles(robot.bodies.size(), JointRole::kHeld);
  for (std::size_t i = 1; i < robot.bodies.size(); ++i) roles[i] = role_of(robot.bodies[i].joint);
  for (const auto* rolling : {&gear.wheels, &gear.casters}) {
    for (const RollingBody& wheel : *rolling) {
      for (std::size_t i = wheel.body; i != 0; i = robot.bodies[i].parent) roles[i] = JointRole::kPassive;
    }
  }
  for (const RollingBody& wheel : gear.wheels) roles[wheel.body] = JointRole::kDriven;
  return roles;
}

}  // namespace robot_control
