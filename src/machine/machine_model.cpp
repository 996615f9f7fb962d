#include "machine/machine_model.h"

#include "machine/bodies/gyration.h"
#include "machine/bodies/posed_bodies.h"
#include "machine/machine_reading.h"
#include "machine/model_hash.h"
#include "machine/suspicions.h"

namespace robot_control {
namespace {

std::vector<std::string> ends_with_a_shape(const RigidBodies& bodies) {
  std::vector<bool> carries(bodies.bodies.size(), false);
  for (std::size_t i = 1; i < bodies.bodies.size(); ++i) carries[bodies.bodies[i].parent] = true;
  std::vector<std::string> ends;
  for (std::size_t i = 1; i < bodies.bodies.size(); ++i) {
    if (!carries[i] && !bodies.bodies[i].shapes.empty()) ends.push_back(bodies.bodies[i].name);
  }
  return ends;
}

}  // namespace

const char* name_of(RobotNote::Kind kind) {
  constexpr std::array<const char*, 5> kNames{"assumed", "repaired", "ignored", "overridden", "suspicious"};
  return kNames.at(static_cast<std::size_t>(kind));
}

namespace {

template <class Counts>
std::vector<std::size_t> joint_indices(const MachineModel& machine, Counts counts) {
  std::vector<std::size_t> joints;
  for (std::size_t joint = 0; joint < machine.joints.size(); ++joint) {
    if (counts(machine.joints[joint].role)) joints.push_back(joint);
  }
  return joints;
}

}  // namespace

std::vector<std::size_t> driven_joint_indices(const MachineModel& machine) {
  return joint_indices(machine, [](JointRole role) { return role == JointRole::kDriven; });
}

std::vector<std::size_t> actuated_joint_indices(const MachineModel& machine) {
  return joint_indices(machine, [](JointRole role) { return role != JointRole::kPassive; });
}

MachineModel read_machine(const RobotDescription& description, const MachineParameters& parameters) {
  const auto bodies = std::make_shared<const RigidBodies>(read_rigid_bodies(description));
  if (bodies->moving_joints.empty()) {
    refuse(bodies->source, "<robot>", "no joint moves",
           "Add joints of type=\"revolute\", \"continuous\" or \"prismatic\"");
  }
  refuse_too_many_joints(*bodies);
  MachineModel machine = named_machine(description, *bodies);
  ModelHash hash;
  hash.add(description.text);
  hash.add(parameters);
  machine.hash = hash.value();
  for (const std::string& name : bodies->moving_joints) {
    const RigidBody& body = *bodies->moved_by(name);
    machine.joints.push_back(joint_model(*bodies, body, role_of(body.joint)));
  }
  note_resting_places(machine);
  const double size = robot_size(*bodies);
  const RigidBodies at_rest = resting(*bodies, machine.joints);
  read_masses(at_rest, parameters, size, machine);
  read_imu(at_rest, parameters, size, machine);
  machine.contacts = ends_with_a_shape(*bodies);
  machine.bodies = bodies;
  note_suspicious_bodies(machine);
  machine.notes = merged(machine.notes);
  return machine;
}

}  // namespace robot_control
