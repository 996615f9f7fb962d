#include "machine/wheeled/wheels/rockers.h"

#include <cmath>

#include "machine/bodies/rolling.h"
#include "machine/description/wording.h"

namespace robot_control {
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
                   "a differential: it turns as " + leader.name +
                       " does, the other way round; else the body between "
                       "the two would tip to their stops"});
}

}  // namespace robot_control
