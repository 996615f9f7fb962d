#include "robot/suspicions.h"

#include <algorithm>
#include <cmath>

#include "description/wording.h"
#include "robot/bodies/rigid_bodies.h"
#include "robot/bodies/shape_support.h"
#include "robot/bodies/tipping.h"
#include "robot/gravity.h"

namespace robot_control {
namespace {

void note(RobotModel& robot, const std::string& element, const std::string& text) {
  robot.notes.push_back({RobotNote::Kind::kSuspicious, element, text});
}

Eigen::AlignedBox3d box_of(const RigidBody& body, const Shape& shape) {
  Eigen::AlignedBox3d box;
  Eigen::Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d u = body.in_root.linear().transpose() * Eigen::Vector3d::Unit(axis);
    low[axis] = body.in_root.translation()[axis] - support(shape, -u);
    high[axis] = body.in_root.translation()[axis] + support(shape, u);
  }
  box.extend(low);
  box.extend(high);
  return box;
}

void note_lengths(RobotModel& robot) {
  for (const WheelModel& wheel : robot.wheels) {
    if (wheel.radius < kLargestWheel) continue;
    note(robot, joint_element(robot.joints[wheel.joint].name),
         "a wheel radius of " + number(wheel.radius) + " m: are lengths in millimetres? A URDF's are metres");
  }
  for (const RigidBody& body : robot.bodies->bodies) {
    for (const Shape& shape : body.shapes) {
      const double size = box_of(body, shape).sizes().maxCoeff();
      if (size < kLargestPart) continue;
      note(robot, link_element(shape.link),
           "a shape that measures " + number(size) +
               " m: are lengths in millimetres? For a mesh in millimetres give "
               "scale=\"0.001 0.001 0.001\"");
    }
  }
}

void note_masses(RobotModel& robot) {
  Eigen::AlignedBox3d box;
  double mass = 0;
  for (const RigidBody& body : robot.bodies->bodies) {
    mass += body.mass;
    for (const Shape& shape : body.shapes) box.extend(box_of(body, shape));
  }
  if (!box.isEmpty() && mass > kSteel * box.volume()) {
    note(robot, "<robot>",
         number(mass) + " kg, more than a block of steel of the robot's size (" + number(box.sizes().x()) + " × " +
             number(box.sizes().y()) + " × " + number(box.sizes().z()) + " m): are masses in grams? A URDF's are kg");
  }
  const RigidBody& base = robot.bodies->bodies[0];
  if (base.mass < kLightBase * mass) {
    note(robot, link_element(base.name),
         "it and what is fixed to it weigh only " + number(base.mass) + " of " + number(mass) +
             " kg: is its <inertial> missing?");
  }
}

/// m/s²; empty where a wheel's torque limit is not the user's or the file's.
std::optional<double> given_deceleration(const RobotModel& robot) {
  double force = 0;
  for (const WheelModel& wheel : robot.wheels) {
    const JointModel& joint = robot.joints[wheel.joint];
    if (joint.effort_limit != robot.bodies->moved_by(joint.name)->joint.effort_limit) return {};
    force += joint.effort_limit / wheel.radius;
  }
  return std::min(kGravity, force / robot.mass);
}

void note_tipping(RobotModel& robot) {
  const double limit = given_deceleration(robot).value_or(kRamp);
  const double lifting = lifting_deceleration(robot);
  if (!(lifting > 0) || lifting >= limit) return;
  note(robot, "<robot>",
       "its centre of gravity lies so high, or so near to where it stands, that it tips from " + number(lifting) +
           " m/s² on; its own limit is " + number(limit) + " m/s²");
}

void note_mecanum(RobotModel& robot) {
  if (robot.wheels.size() == 2 || lower_case(robot.urdf).find("mecanum") == std::string::npos) return;
  note(robot, "<robot>", "it speaks of mecanum wheels: they are driven as plain ones, and do not roll sideways");
}

}  // namespace

void note_suspicions(RobotModel& robot) {
  note_lengths(robot);
  note_masses(robot);
  note_tipping(robot);
  note_mecanum(robot);
}

}  // namespace robot_control
