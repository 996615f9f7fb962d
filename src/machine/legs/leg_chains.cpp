#include "machine/legs/leg_chains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "machine/bodies/rolling.h"
#include "machine/description/wording.h"
#include "machine/legs/leg_model.h"

namespace robot_control {
namespace {

constexpr std::array<const char*, kLegJoints> kJointNames{"hip", "thigh", "knee"};

bool turns(const RigidBody& body) {
  return body.joint.type == JointType::kRevolute || body.joint.type == JointType::kContinuous;
}

/// Returns the axis of the base to which that of the joint is nearest.
Eigen::Index nearest_axis(const RigidBody& body) {
  Eigen::Index nearest = 0;
  axis_in_base(body).cwiseAbs().maxCoeff(&nearest);
  return nearest;
}

bool begins_as_leg(const RigidBodies& robot, const BodyChain& chain) {
  bool begins = chain.bodies.size() >= kLegJoints;
  for (std::size_t i = 0; i < kLegJoints && begins; ++i) {
    const RigidBody& body = robot.bodies[chain.bodies[i]];
    begins = turns(body) && nearest_axis(body) == leg_axis(i);
  }
  return begins;
}

bool rolls(const RigidBodies& robot, const BodyChain& chain) {
  return measure_wheel(robot.bodies[chain.bodies.back()]).objection.empty();
}

/// Returns all chains on the root body. A chain that branches ends there.
std::vector<BodyChain> chains_of(const RigidBodies& robot) {
  std::vector<std::vector<std::size_t>> children(robot.bodies.size());
  for (std::size_t i = 1; i < robot.bodies.size(); ++i) children[robot.bodies[i].parent].push_back(i);
  std::vector<BodyChain> chains;
  for (const std::size_t first : children[0]) {
    chains.push_back({{first}});
    std::vector<std::size_t>& bodies = chains.back().bodies;
    while (children[bodies.back()].size() == 1) bodies.push_back(children[bodies.back()].front());
  }
  return chains;
}

std::string ends_of(const RigidBodies& robot, const std::vector<BodyChain>& chains) {
  std::vector<std::string> names;
  for (const BodyChain& chain : chains) names.push_back(robot.bodies[chain.bodies.back()].name);
  return list(names);
}

constexpr const char* kAxesRule = "at zero angles, the axes of a leg are x, y and y";
constexpr const char* kAxesRemedy = "Correct its <axis xyz=\"…\">, or the <origin rpy=\"…\"> of the joints up to it";

/// Names all axes that are off those of a leg. They are nearer to these than to others.
void refuse_other_axes(const RigidBodies& robot, const std::vector<BodyChain>& chains) {
  const RigidBody* first = nullptr;
  std::string text, others;
  for (const BodyChain& chain : chains) {
    for (std::size_t i = 0; i < kLegJoints; ++i) {
      const RigidBody& body = robot.bodies[chain.bodies[i]];
      const double off = std::acos(std::min(1.0, std::abs(axis_in_base(body)[leg_axis(i)])));
      if (off <= kAxleTolerance) continue;
      const std::string angle = number(std::round(off * 1800 / std::numbers::pi) / 10) + "°";
      if (first == nullptr) {
        first = &body;
        text = "its axis is " + angle + " off the " + (i == 0 ? "lengthwise (x)" : "lateral (y)") + " axis of " +
               robot.bodies[0].name + ", allowed is 0.2°";
      } else {
        others += (others.empty() ? "; also off: " : ", ") + body.joint.name + " by " + angle;
      }
    }
  }
  if (first != nullptr) refuse(robot.source, joint_element(first->joint.name), text, kAxesRule + others, kAxesRemedy);
}

/// Names the first difference of a limb from a leg, and the limbs that have the same one.
[[noreturn]] void refuse_limbs(const RigidBodies& robot, const std::vector<BodyChain>& limbs) {
  const auto bodies = [&](std::size_t joint) {
    std::vector<const RigidBody*> moved;
    for (const BodyChain& limb : limbs) {
      if (limb.bodies.size() >= kLegJoints) moved.push_back(&robot.bodies[limb.bodies[joint]]);
    }
    return moved;
  };
  std::vector<std::string> same;
  const auto collect = [&](const RigidBody& first, const auto& is_the_same, std::size_t joint) {
    for (const RigidBody* body : bodies(joint)) {
      if (body != &first && is_the_same(*body)) same.push_back(body->joint.name);
    }
    return same.empty() ? "" : "; the same applies to " + list(same);
  };
  const std::string almost = "almost a quadruped: ";
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    for (const RigidBody* body : bodies(i)) {
      const std::string joint = std::string("the ") + kJointNames[i];
      if (!turns(*body)) {
        refuse(robot.source, joint_element(body->joint.name),
               almost + joint + " is prismatic, but leg joints turn" +
                   collect(
                       *body, [](const RigidBody& other) { return !turns(other); }, i),
               "Set type=\"revolute\"");
      }
      const Eigen::Index axis = nearest_axis(*body);
      if (axis == leg_axis(i)) continue;
      refuse(robot.source, joint_element(body->joint.name),
             almost + joint + "'s axis is " + "xyz"[axis] + ", but " + kAxesRule +
                 collect(
                     *body, [axis](const RigidBody& other) { return nearest_axis(other) == axis; }, i),
             kAxesRemedy);
    }
  }
  const BodyChain& shortest = limbs.front();  // no other differs
  refuse(robot.source, link_element(robot.bodies[shortest.bodies.back()].name),
         almost + "the leg that ends here has " + std::to_string(shortest.bodies.size()) +
             " moving joints, but a leg has three: " + kAxesRule,
         "Add the missing joints: hip, thigh and knee turn");
}

}  // namespace

Eigen::Vector3d axis_in_base(const RigidBody& body) {
  return body.in_root.linear() * body.joint.axis;
}

std::vector<BodyChain> leg_chains(const RigidBodies& robot) {
  std::vector<BodyChain> chains = chains_of(robot);
  std::erase_if(chains, [&](const BodyChain& chain) { return !begins_as_leg(robot, chain); });
  return chains;
}

std::vector<BodyChain> limbs_of(const RigidBodies& robot) {
  std::vector<BodyChain> chains = chains_of(robot);
  std::erase_if(chains, [&](const BodyChain& chain) { return chain.bodies.size() < 2 || rolls(robot, chain); });
  return chains;
}

bool has_legs(const RigidBodies& bodies) {
  const std::vector<BodyChain> chains = leg_chains(bodies);
  const auto fits = [](const BodyChain& chain) { return chain.bodies.size() <= kLegJoints + 1; };
  if (std::ranges::count_if(chains, fits) >= 2) return true;
  const auto rolling = [&](const BodyChain& chain) { return rolls(bodies, chain); };
  return limbs_of(bodies).size() >= kLegs && std::ranges::none_of(chains_of(bodies), rolling);
}

void refuse_other_chains(const RigidBodies& robot, const std::vector<BodyChain>& chains) {
  std::vector<BodyChain> limbs = limbs_of(robot);
  if (chains.size() < kLegs && limbs.size() >= kLegs) {
    std::erase_if(limbs, [&](const BodyChain& limb) { return begins_as_leg(robot, limb); });
    refuse_limbs(robot, limbs);
  }
  refuse_other_axes(robot, chains);
  for (const BodyChain& chain : chains) {
    if (chain.bodies.size() == kLegJoints) continue;
    refuse(robot.source, joint_element(robot.bodies[chain.bodies[kLegJoints]].joint.name),
           "it is a fourth moving joint of a leg: wheels or moving feet on legs are not supported",
           "Set type=\"fixed\" on this joint");
  }
  if (chains.size() != kLegs) {
    refuse(robot.source, "<robot>",
           std::to_string(chains.size()) + (chains.size() == 1 ? " leg found" : " legs found") +
               (chains.empty() ? "" : " (to " + ends_of(robot, chains) + ")") + ", but a quadruped has four",
           "Add the missing legs: a leg is three joints in series from the root link; at zero angles, their axes are "
           "x, y and y");
  }
  std::set<std::size_t> of_legs{0};
  for (const BodyChain& chain : chains) of_legs.insert(chain.bodies.begin(), chain.bodies.end());
  for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
    if (of_legs.contains(i)) continue;
    refuse(robot.source, joint_element(robot.bodies[i].joint.name), "it moves, but is not part of a leg",
           "Set type=\"fixed\": only the twelve leg joints of a quadruped may move");
  }
}

}  // namespace robot_control
