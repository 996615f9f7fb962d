#include "machine/wheeled/wheels/suspension.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "machine/description/wording.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

constexpr double kMostlyUpright = 0.7;  // |z| of the axis: within 45° of the vertical

double upward(const RigidBody& body) {
  return (body.in_root.linear() * body.joint.axis).z();
}

double mass_on(const RigidBodies& robot, std::size_t body) {
  double mass = 0;
  for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
    std::size_t ancestor = i;
    while (ancestor != 0 && ancestor != body) ancestor = robot.bodies[ancestor].parent;
    if (ancestor == body) mass += robot.bodies[i].mass;
  }
  return mass;
}

}  // namespace

bool is_suspension(const RigidBodies& robot, std::size_t body) {
  const RigidBody& candidate = robot.bodies[body];
  return body != 0 && candidate.joint.type == JointType::kPrismatic && std::abs(upward(candidate)) > kMostlyUpright;
}

void assume_springs(RigidBodies& robot, const RunningGear& gear, std::vector<RobotNote>& notes) {
  std::set<std::size_t> springs;
  for (const RollingBody& wheel : gear.wheels) {
    for (std::size_t i = robot.bodies[wheel.body].parent; i != 0; i = robot.bodies[i].parent) {
      if (is_suspension(robot, i)) springs.insert(i);
    }
  }
  double above = total_mass(robot);
  for (const std::size_t spring : springs) above -= mass_on(robot, spring);
  const double share = above / static_cast<double>(gear.wheels.size() + gear.casters.size());
  const double omega = 2 * M_PI * kSuspensionFrequency;
  for (const std::size_t spring : springs) {
    BodyJoint& joint = robot.bodies[spring].joint;
    joint.spring_load = std::copysign(share * kGravity, -upward(robot.bodies[spring]));
    joint.spring_stiffness = share * omega * omega;
    joint.damping = std::max(joint.damping, 2 * share * omega);
    notes.push_back({RobotNote::Kind::kAssumed, joint_element(joint.name),
                     "a spring of " + number(joint.spring_stiffness) + " N/m that carries " + number(share) +
                         " kg at zero, damping " + number(joint.damping) + " N·s/m"});
  }
}

}  // namespace robot_control
