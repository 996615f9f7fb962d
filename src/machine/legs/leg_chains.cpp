#include "machine/legs/leg_chains.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "machine/bodies/rolling.h"
#include "machine/description/wording.h"
#include "machine/legs/leg_model.h"

namespace robot_control {
namespace {

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

std::string ends_of(const RigidBodies& robot, const std::vector<BodyChain>& chains) {
  std::vector<std::string> names;
  for (const BodyChain& chain : chains) names.push_back(robot.bodies[chain.bodies.back()].name);
  return list(names);
}

void refuse_other_axes(const RigidBodies& robot, const BodyChain& chain) {
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const RigidBody& body = robot.bodies[chain.bodies[i]];
    const double off = std::acos(std::min(1.0, std::abs(axis_in_base(body)[leg_axis(i)])));
    if (off <= kAxleTolerance) continue;
    const std::string axis = i == 0 ? "lengthwise (x)" : "lateral (y)";
    refuse(robot.source, joint_element(body.joint.name),
           "its axis is " + number(std::round(off * 1800 / std::numbers::pi) / 10) + "° off the " + axis + " axis of " +
               robot.bodies[0].name + ", 0.2° are allowed: a leg turns about x, y and y at the zero pose",
           "Correct its <axis xyz=\"…\">, or the <origin rpy=\"…\"> of the joints up to it");
  }
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

bool has_legs(const RigidBodies& bodies) {
  const std::vector<BodyChain> chains = leg_chains(bodies);
  const auto fits = [](const BodyChain& chain) { return chain.bodies.size() <= kLegJoints + 1; };
  return std::ranges::count_if(chains, fits) >= 2;
}

void refuse_other_chains(const RigidBodies& robot, const std::vector<BodyChain>& chains) {
  for (const BodyChain& chain : chains) {
    refuse_other_axes(robot, chain);
    if (chain.bodies.size() == kLegJoints) continue;
    refuse(robot.source, joint_element(robot.bodies[chain.bodies[kLegJoints]].joint.name),
           "it moves on a leg, behind the leg's three joints: wheels or feet on legs are not supported",
           "Make this joint type=\"fixed\", or describe a robot whose legs end in feet");
  }
  if (chains.size() != kLegs) {
    refuse(robot.source, "<robot>",
           std::to_string(chains.size()) + (chains.size() == 1 ? " leg found" : " legs found") +
               (chains.empty() ? "" : " (to " + ends_of(robot, chains) + ")") + ", a quadruped has four",
           "A leg is three joints in a row on the root link that turn about x, y and y at the zero pose");
  }
  std::set<std::size_t> of_legs{0};
  for (const BodyChain& chain : chains) of_legs.insert(chain.bodies.begin(), chain.bodies.end());
  for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
    if (of_legs.contains(i)) continue;
    refuse(robot.source, joint_element(robot.bodies[i].joint.name), "it moves, but belongs to no leg",
           "Make it type=\"fixed\": besides its twelve leg joints nothing on a quadruped may move");
  }
}

}  // namespace robot_control
