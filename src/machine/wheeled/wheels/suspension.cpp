#include "machine/wheeled/wheels/suspension.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "machine/bodies/rolling.h"
#include "machine/description/wording.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

constexpr double kMinUpright = 0.7;  // |z| of the axis: within 45° of the vertical

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
  return body != 0 && candidate.joint.type == JointType::kPrismatic && std::abs(upward(candidate)) > kMinUpright;
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

namespace {

constexpr std::size_t kNone = 0;  // The root is no rocker.

Eigen::Vector3d axis_in_root(const RigidBody& body) {
  return body.in_root.linear() * body.joint.axis;
}

bool pitches(const RigidBody& body) {
  return turns_upright(body) && std::abs(axis_in_root(body).y()) > std::cos(kAxleTolerance);
}

/// Returns the one body that directly carries all drive wheels of a side, if it pitches; else kNone.
std::size_t rocker_of(const RigidBodies& robot, const RunningGear& gear, Side side) {
  std::size_t rocker = kNone;
  std::size_t wheels = 0;
  for (const RollingBody& wheel : gear.wheels) {
    if (wheel.wheel.side != side) continue;
    const std::size_t parent = robot.bodies[wheel.body].parent;
    if (wheels++ > 0 && parent != rocker) return kNone;
    rocker = parent;
  }
  return wheels > 1 && rocker != kNone && pitches(robot.bodies[rocker]) ? rocker : kNone;
}

}  // namespace

void assume_differential(RigidBodies& robot, const RunningGear& gear, std::vector<RobotNote>& notes) {
  const std::size_t left = rocker_of(robot, gear, Side::kLeft);
  const std::size_t right = rocker_of(robot, gear, Side::kRight);
  if (left == kNone || right == kNone || left == right) return;
  const BodyJoint& leader = robot.bodies[left].joint;
  BodyJoint& follower = robot.bodies[right].joint;
  if (robot.bodies[left].parent != robot.bodies[right].parent) return;
  if (!leader.mimicked.empty() || !follower.mimicked.empty()) return;
  follower.mimicked = leader.name;
  follower.mimic_multiplier = axis_in_root(robot.bodies[left]).dot(axis_in_root(robot.bodies[right])) > 0 ? -1 : 1;
  notes.push_back({RobotNote::Kind::kAssumed, joint_element(follower.name),
                   "a differential: it turns opposite to " + leader.name +
                       "; otherwise, the body between the two would tip to the end stops"});
}

}  // namespace robot_control
