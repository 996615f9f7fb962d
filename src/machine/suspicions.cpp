#include "machine/suspicions.h"

#include "machine/bodies/gravity_load.h"
#include "machine/bodies/posed_bodies.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/bodies/shape_support.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

void note(MachineModel& robot, const std::string& element, const std::string& text) {
  robot.notes.push_back({RobotNote::Kind::kSuspicious, element, text});
}

void note_shapes(MachineModel& robot) {
  for (const RigidBody& body : robot.bodies->bodies) {
    for (const Shape& shape : body.shapes) {
      const double size = box_of(body, shape).sizes().maxCoeff();
      if (size < kMaxPart) continue;
      note(robot, link_element(shape.link),
           "the size of a shape is " + number(size) +
               " m: check whether lengths are in millimetres. For a mesh in millimetres, set "
               "scale=\"0.001 0.001 0.001\"");
    }
  }
}

void note_masses(MachineModel& robot) {
  Eigen::AlignedBox3d box;
  double mass = 0;
  for (const RigidBody& body : robot.bodies->bodies) {
    mass += body.mass;
    for (const Shape& shape : body.shapes) box.extend(box_of(body, shape));
  }
  if (!box.isEmpty() && mass > kSteelDensity * box.volume()) {
    note(robot, "<robot>",
         number(mass) + " kg, more than a steel block of the size of the robot (" + number(box.sizes().x()) + " × " +
             number(box.sizes().y()) + " × " + number(box.sizes().z()) +
             " m): check whether masses are in grams; a URDF has kg");
  }
  const RigidBody& base = robot.bodies->bodies[0];
  if (base.mass < kMinBaseShare * mass) {
    note(robot, link_element(base.name),
         "it and the links fixed to it weigh only " + number(base.mass) + " of " + number(mass) +
             " kg: check whether its <inertial> is missing");
  }
}

void note_weak_joints(MachineModel& robot) {
  const RigidBodies at_rest = resting(*robot.bodies, robot.joints);
  for (const JointModel& joint : robot.joints) {
    if (joint.role != JointRole::kHeld) continue;
    const auto body = static_cast<std::size_t>(at_rest.moved_by(joint.name) - at_rest.bodies.data());
    const double load = gravity_load(at_rest, body);
    if (load <= joint.effort_limit + joint.friction) continue;
    const char* const unit = joint.prismatic ? " N" : " N·m";
    note(robot, joint_element(joint.name),
         "its effort limit of " + number(joint.effort_limit) + unit + " is below its load of " + number(load) + unit +
             " at rest: it cannot hold its position");
  }
}

}  // namespace

std::string suspicions_of(const MachineModel& robot) {
  std::string text;
  for (const RobotNote& note : robot.notes) {
    if (note.kind == RobotNote::Kind::kSuspicious) text += "; " + note.element + ": " + note.text;
  }
  return text.empty() ? text : "Suspicious" + text.replace(0, 1, ":");
}

void note_suspicious_bodies(MachineModel& machine) {
  note_shapes(machine);
  note_masses(machine);
  note_weak_joints(machine);
}

}  // namespace robot_control
