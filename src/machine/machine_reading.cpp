#include "machine/machine_reading.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"
#include "machine/overrides.h"
#include "signals/joint.h"

namespace robot_control {
namespace {

bool is_letter(char c) {
  return c >= 'a' && c <= 'z';
}

/// Returns true if a word in `name` begins with `word`; "simulated" contains an "imu", too.
bool begins_word(const std::string& name, const std::string& word) {
  for (std::size_t at = name.find(word); at != std::string::npos; at = name.find(word, at + 1)) {
    if (at == 0 || !is_letter(name[at - 1])) return true;
  }
  return false;
}

bool fixed_to_root(const RigidBodies& robot, const std::string& link) {
  const auto place = robot.links.find(link);
  return place != robot.links.end() && place->second.body == 0;
}

std::string words(const Eigen::Vector3d& v) {
  return list({length(v.x()), length(v.y()), length(v.z())});
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& rpy) {
  return Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
}

Eigen::Vector3d rpy_of(const Eigen::Matrix3d& r) {
  return {std::atan2(r(2, 1), r(2, 2)), std::asin(std::clamp(-r(2, 0), -1.0, 1.0)), std::atan2(r(1, 0), r(0, 0))};
}

Eigen::Vector3d finite(const RigidBodies& robot, const std::string& element, const std::string& unit,
                       const Vector3& given) {
  Eigen::Vector3d vector(given[0], given[1], given[2]);
  if (!vector.allFinite()) {
    refuse(robot.source, element, words(vector) + " " + unit, "Set three finite numbers, or none");
  }
  return vector;
}

/// Returns the link of the IMU; empty: the IMU is in the base. It is `requested_link` if that is not empty, else
/// "imu_link". Else it is the first link in the file with a word that begins with "imu" or "gyro". A link that moves
/// against the root is not used. Throws RobotError if the requested link does not exist or moves.
std::string imu_link_of(const RigidBodies& robot, const std::string& requested_link, std::vector<RobotNote>& notes) {
  const std::string& base = robot.bodies[0].name;
  if (!requested_link.empty()) {
    if (!robot.links.contains(requested_link)) {
      refuse(robot.source, "robot.imu_link", "there is no link \"" + requested_link + "\"",
             "Set a link of the URDF, or none: then the IMU is found, or assumed in " + base);
    }
    if (!fixed_to_root(robot, requested_link)) {
      refuse(robot.source, link_element(requested_link), "it moves relative to " + base,
             "Set a link that is fixed to the chassis");
    }
    return requested_link == base ? "" : requested_link;
  }
  if (fixed_to_root(robot, "imu_link")) return "imu_link";
  for (const std::string& link : robot.link_order) {
    const std::string name = lower_case(link);
    if (!begins_word(name, "imu") && !begins_word(name, "gyro")) continue;
    if (!fixed_to_root(robot, link)) {
      notes.push_back({RobotNote::Kind::kIgnored, link_element(link),
                       "it moves relative to " + base + ": the IMU cannot be there"});
      continue;
    }
    notes.push_back({RobotNote::Kind::kAssumed, link_element(link), "the IMU is here"});
    return link == base ? "" : link;
  }
  notes.push_back({RobotNote::Kind::kAssumed, link_element(base), "no link has the name of an IMU: assumed here"});
  return "";
}

/// Returns the pose of the IMU in the base's axes: at `link` (empty: in the base), unless imu_position and
/// imu_orientation say otherwise. A difference of more than 1 % of `length` (m), or 0.01 rad, is noted. Throws
/// RobotError if a number is not finite.
Pose imu_pose(const RigidBodies& robot, const std::string& link, const MachineParameters& parameters, double length,
              std::vector<RobotNote>& notes) {
  Eigen::Isometry3d place = link.empty() ? Eigen::Isometry3d::Identity() : robot.links.at(link).in_body;
  Eigen::Quaterniond rotation(place.linear());
  if (parameters.imu_position) {
    const Eigen::Vector3d given = finite(robot, "robot.imu_position", "m", *parameters.imu_position);
    if ((given - place.translation()).norm() > kNotedShare * length) {
      notes.push_back({RobotNote::Kind::kOverridden, "robot.imu_position",
                       words(given) + " m is used, the URDF has " + words(place.translation()) + " m"});
    }
    place.translation() = given;
  }
  if (parameters.imu_orientation) {
    const Eigen::Vector3d given = finite(robot, "robot.imu_orientation", "rad", *parameters.imu_orientation);
    const Eigen::Quaterniond from_urdf = rotation;
    rotation = rotation_of(given);
    if (rotation.angularDistance(from_urdf) > kNotedShare) {
      notes.push_back({RobotNote::Kind::kOverridden, "robot.imu_orientation",
                       words(given) + " rad is used, the URDF has " + words(rpy_of(place.linear())) + " rad"});
    }
  }
  const Eigen::Vector3d& position = place.translation();
  return {.position = {position.x(), position.y(), position.z()},
          .orientation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()}};
}

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
  const Eigen::Vector3d centre = finite(bodies, "robot.centre_of_gravity", "m", *parameters.centre_of_gravity);
  if ((centre - from_urdf).norm() > kNotedShare * length) {
    machine.notes.push_back({RobotNote::Kind::kOverridden, "robot.centre_of_gravity",
                             words(centre) + " m is used, the URDF has " + words(from_urdf) + " m"});
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
         "Set type=\"fixed\" on joints that never move; the limit is " + std::to_string(kMaxJoints));
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
