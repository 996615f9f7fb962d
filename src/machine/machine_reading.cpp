#include "machine/machine_reading.h"

#include <algorithm>

#include "machine/description/wording.h"
#include "machine/imu_place.h"
#include "machine/overrides.h"
#include "signals/joint.h"

namespace robot_control {
namespace {

std::optional<JointRange> range_of(const BodyJoint& joint) {
  if (!joint.mimicked.empty() || !(joint.lower < joint.upper)) return std::nullopt;
  return JointRange{joint.lower, joint.upper};
}

double rest_position(const RigidBodies& bodies, const BodyJoint& joint) {
  const RigidBody* const leader = bodies.moved_by(joint.mimicked);
  if (leader != nullptr) return joint.mimic_multiplier * rest_position(bodies, leader->joint) + joint.mimic_offset;
  return joint.lower < joint.upper ? std::clamp(0.0, joint.lower, joint.upper) : 0;
}

Eigen::Vector3d effective_centre(const RigidBodies& bodies, const MachineParameters& parameters, double length,
                                 const Eigen::Vector3d& from_urdf, MachineModel& machine) {
  if (!parameters.centre_of_gravity) return from_urdf;
  const Vector3& given = *parameters.centre_of_gravity;
  Eigen::Vector3d centre(given[0], given[1], given[2]);
  const auto words = [](const Eigen::Vector3d& v) { return list({number(v.x()), number(v.y()), number(v.z())}); };
  if (!centre.allFinite()) {
    refuse(bodies.source, "robot/centre_of_gravity", words(centre) + " m", "Give three finite numbers, or none");
  }
  if ((centre - from_urdf).norm() > kWorthNoting * length) {
    machine.notes.push_back({RobotNote::Kind::kOverridden, "robot/centre_of_gravity",
                             words(centre) + " m holds, the URDF says " + words(from_urdf) + " m"});
  }
  return centre;
}

}  // namespace

MachineModel named_machine(const RobotDescription& description, const RigidBodies& bodies) {
  MachineModel machine;
  machine.name = bodies.name;
  machine.source = description.source;
  machine.urdf = description.text;
  machine.base_link = bodies.bodies[0].name;
  machine.notes = bodies.notes;
  return machine;
}

void refuse_too_many_joints(const RigidBodies& bodies) {
  if (bodies.moving_joints.size() <= kMaxJoints) return;
  refuse(bodies.source, "<robot>", std::to_string(bodies.moving_joints.size()) + " moving joints",
         "At most " + std::to_string(kMaxJoints) + " are supported; make those that never move type=\"fixed\"");
}

JointRole role_of(const BodyJoint& joint) {
  return joint.mimicked.empty() && joint.effort_limit > 0 ? JointRole::kHeld : JointRole::kPassive;
}

JointModel joint_model(const RigidBodies& bodies, const RigidBody& body, JointRole role) {
  return {.name = body.joint.name,
          .child_link = body.name,
          .effort_limit = role == JointRole::kPassive ? 0 : body.joint.effort_limit,
          .velocity_limit = body.joint.velocity_limit,
          .role = role,
          .damping = body.joint.damping,
          .friction = body.joint.friction,
          .range = range_of(body.joint),
          .prismatic = body.joint.type == JointType::kPrismatic,
          .rest_position = rest_position(bodies, body.joint)};
}

void note_resting_places(MachineModel& machine) {
  for (const JointModel& joint : machine.joints) {
    if (joint.rest_position == 0) continue;
    const char* const unit = joint.prismatic ? " m" : " rad";
    const std::string why = joint.range ? "its range from " + number(joint.range->lower) + " to " +
                                              number(joint.range->upper) + unit + " does not contain zero"
                                        : "the joint that it follows puts it there";
    machine.notes.push_back({RobotNote::Kind::kAssumed, joint_element(joint.name),
                             "rests at " + number(joint.rest_position) + unit + ": " + why});
  }
}

MassSum sum_of_masses(const RigidBodies& bodies) {
  MassSum sum;
  for (const RigidBody& body : bodies.bodies) {
    sum.mass += body.mass;
    sum.centre += body.mass * (body.in_root * body.centre_of_gravity);
  }
  sum.centre /= sum.mass;
  for (const RigidBody& body : bodies.bodies) {
    const Eigen::Vector3d up = body.in_root.linear().transpose() * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d lever = body.in_root * body.centre_of_gravity - sum.centre;
    sum.yaw_inertia += up.dot(body.inertia * up) + body.mass * lever.head<2>().squaredNorm();
  }
  return sum;
}

void read_masses(const RigidBodies& bodies, const MachineParameters& parameters, double length, MachineModel& machine) {
  const MassSum sum = sum_of_masses(bodies);
  machine.mass = overridden("mass", "kg", parameters.mass, sum.mass, bodies, machine.notes);
  const Eigen::Vector3d centre = effective_centre(bodies, parameters, length, sum.centre, machine);
  machine.centre_of_gravity_base = {centre.x(), centre.y(), centre.z()};
}

void read_imu(const RigidBodies& bodies, const MachineParameters& parameters, double length, MachineModel& machine) {
  machine.imu_link = imu_link_of(bodies, parameters.imu_link, machine.notes);
  machine.imu_in_base = imu_pose(bodies, machine.imu_link, parameters, length, machine.notes);
}

std::vector<RobotNote> merged(const std::vector<RobotNote>& notes) {
  std::vector<RobotNote> result;
  for (const RobotNote& note : notes) {
    const auto same = std::find_if(result.begin(), result.end(), [&](const RobotNote& other) {
      return other.kind == note.kind && other.text == note.text;
    });
    if (same == result.end()) {
      result.push_back(note);
    } else if (same->element.find(note.element) == std::string::npos) {
      same->element += ", " + note.element;
    }
  }
  return result;
}

}  // namespace robot_control
