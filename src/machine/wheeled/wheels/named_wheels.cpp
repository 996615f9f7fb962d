#include "machine/wheeled/wheels/named_wheels.h"

#include <algorithm>
#include <cmath>

#include "machine/bodies/rolling.h"
#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"
#include "machine/wheeled/wheels/rollers.h"
#include "machine/wheeled/wheels/wheel_pairs.h"

namespace robot_control {
namespace {

RollingBody named_wheel(const RigidBodies& robot, const std::string& joint) {
  const std::string element = joint_element(joint);
  const auto found = robot.joints.find(joint);
  if (found == robot.joints.end()) {
    refuse(robot.source, element, "there is no such joint (moving joints: " + list(robot.moving_joints) + ")",
           kSetWheels);
  }
  if (found->second == JointType::kFixed) {
    refuse(robot.source, element, kFixedWheel, kContinuous);
  }
  const RigidBody& body = *robot.moved_by(joint);
  const auto index = static_cast<std::size_t>(&body - robot.bodies.data());
  if (const std::size_t rollers = rollers_of(robot, index); rollers > 0) {
    refuse(robot.source, element, rollers_objection(rollers), kRollersRemedy);
  }
  const RollingMeasure measure = measure_wheel(body);
  if (body.joint.type == JointType::kPrismatic) refuse(robot.source, element, measure.objection, measure.fix);
  if (axle_tilt(measure) > kAxleTolerance) {
    refuse(robot.source, element,
           "its axis is " + number(axle_tilt(measure) * 180 / M_PI) + "° off the lateral (y) axis of " +
               robot.bodies[0].name + ", allowed is 0.2°",
           kLateralAxis);
  }
  if (!measure.objection.empty()) refuse(robot.source, link_element(body.name), measure.objection, measure.fix);
  return rolling_body_of(index, measure);
}

}  // namespace

std::vector<RollingBody> named_wheels(const RigidBodies& robot, const DriveTrainParameters& parameters) {
  const auto& left = parameters.left_wheel_joints;
  const auto& right = parameters.right_wheel_joints;
  if (left.size() != right.size()) {
    refuse(robot.source, "robot.left_wheel_joints",
           list(left) + " (robot.right_wheel_joints: " + list(right) + "): the numbers of joints differ",
           "Set the same number of joints on both sides, or none: then they are found");
  }
  std::vector<RollingBody> wheels;
  for (const auto* side : {&left, &right}) {
    for (const std::string& joint : *side) {
      wheels.push_back(named_wheel(robot, joint));
      const std::size_t body = wheels.back().body;
      if (std::count_if(wheels.begin(), wheels.end(), [body](const RollingBody& w) { return w.body == body; }) > 1) {
        refuse(robot.source, "robot." + std::string(side == &left ? "left" : "right") + "_wheel_joints",
               "\"" + joint + "\" is named twice", "Remove one of the two");
      }
    }
  }
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (std::size_t j = left.size(); j < wheels.size(); ++j) {
      if (wheels[i].wheel.centre_base[1] > wheels[j].wheel.centre_base[1]) continue;
      refuse(robot.source, "robot.left_wheel_joints",
             "wheel " + described(robot, wheels[i]) + " is not left of " + described(robot, wheels[j]),
             "Exchange the two names, or turn the robot: x is forward, y is left");
    }
  }
  const PairObjection objection = sort_into_pairs(robot, wheels);
  if (!objection.found.empty()) refuse(robot.source, "robot.left_wheel_joints", objection.found, objection.fix);
  return wheels;
}

}  // namespace robot_control
