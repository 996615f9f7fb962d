#include "machine/robot_model.h"

#include <algorithm>
#include <cmath>

#include "machine/bodies/feet.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/bodies/tipping.h"
#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"
#include "machine/imu_place.h"
#include "machine/joint_roles.h"
#include "machine/model_hash.h"
#include "machine/overrides.h"
#include "machine/suspicions.h"
#include "machine/wheels/bearing_joints.h"
#include "machine/wheels/drive_wheels.h"
#include "machine/wheels/rockers.h"
#include "machine/wheels/suspension.h"
#include "machine/wheels/wheel_drive.h"
#include "signals/joint.h"

namespace robot_control {
namespace {

constexpr double kCentral = 0.05;  // share of the wheel base

Vector3 plain(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void read_geometry(const RigidBodies& robot, const RobotParameters& parameters, DriveTrain& train, RobotModel& model) {
  for (RollingBody& wheel : train.wheels) {
    wheel.wheel.radius =
        overridden("wheel_radius", "m", parameters.wheel_radius, wheel.wheel.radius, robot, model.notes);
    const bool left = wheel.wheel.side == Side::kLeft;
    wheel.wheel.radius *=
        overridden(left ? "left_wheel_radius_multiplier" : "right_wheel_radius_multiplier", "",
                   left ? parameters.left_wheel_radius_multiplier : parameters.right_wheel_radius_multiplier, 1, robot,
                   model.notes);
  }
  model.wheel_base =
      overridden("wheel_base", "m", parameters.wheel_base, wheel_base_of(train.wheels), robot, model.notes);
  const double scrub = scrub_multiplier(train.wheels);
  model.wheel_base_multiplier =
      overridden("wheel_base_multiplier", "", parameters.wheel_base_multiplier, scrub, robot, model.notes);
  if (train.wheels.size() > 2 && !parameters.wheel_base_multiplier) {
    model.notes.push_back({RobotNote::Kind::kAssumed, "robot/wheel_base_multiplier",
                           number(scrub) + ", from where the axles stand; measure it, and set it"});
  }
}

std::optional<JointRange> range_of(const BodyJoint& joint) {
  if (!(joint.lower < joint.upper)) return std::nullopt;
  return JointRange{joint.lower, joint.upper};
}

void add_joint(const RigidBody& body, JointRole role, RobotModel& model) {
  const double effort = role == JointRole::kPassive ? 0 : body.joint.effort_limit;
  model.joints.push_back({.name = body.joint.name,
                          .child_link = body.name,
                          .effort_limit = effort,
                          .velocity_limit = body.joint.velocity_limit,
                          .role = role,
                          .damping = body.joint.damping,
                          .friction = body.joint.friction,
                          .range = range_of(body.joint),
                          .prismatic = body.joint.type == JointType::kPrismatic});
}

/// Wheels turn without end, regardless of their joints' limits.
void free_wheels(RobotModel& model) {
  for (const WheelModel& wheel : model.wheels) model.joints[wheel.joint].range.reset();
  for (const WheelModel& caster : model.casters) model.joints[caster.joint].range.reset();
}

void read_joints(const RigidBodies& robot, const RobotParameters& parameters, DriveTrain& train, RobotModel& model) {
  if (robot.moving_joints.size() > kMaxJoints) {
    refuse(robot.source, "<robot>", std::to_string(robot.moving_joints.size()) + " moving joints",
           "At most " + std::to_string(kMaxJoints) + " are supported; make those that never move type=\"fixed\"");
  }
  const std::vector<JointRole> roles = joint_roles(robot, train);
  for (RollingBody& wheel : train.wheels) {
    wheel.wheel.joint = model.joints.size();
    add_joint(robot.bodies[wheel.body], JointRole::kWheel, model);
    const DriveLimits limits = drive_limits(robot, train, wheel, parameters, model.notes);
    model.joints.back().effort_limit = limits.effort;
    model.joints.back().velocity_limit = limits.velocity;
    const double given = overridden("wheel_effort_rate", "N·m/s", parameters.wheel_effort_rate, 0, robot, model.notes);
    model.joints.back().effort_rate = given > 0 ? given : limits.effort / kEffortRise;
    model.wheels.push_back(wheel.wheel);
  }
  for (const std::string& name : robot.moving_joints) {
    const auto body = static_cast<std::size_t>(robot.moved_by(name) - robot.bodies.data());
    if (roles[body] == JointRole::kWheel) continue;
    for (RollingBody& caster : train.casters) {
      if (caster.body != body) continue;
      caster.wheel.joint = model.joints.size();
      model.casters.push_back(caster.wheel);
    }
    add_joint(robot.bodies[body], roles[body], model);
  }
  free_wheels(model);
}

struct MassSum {
  double mass = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double yaw_inertia = 0;  ///< kg·m² about the vertical through the centre
};

MassSum sum_of_masses(const RigidBodies& robot) {
  MassSum sum;
  for (const RigidBody& body : robot.bodies) {
    sum.mass += body.mass;
    sum.centre += body.mass * (body.in_root * body.centre_of_gravity);
  }
  sum.centre /= sum.mass;
  for (const RigidBody& body : robot.bodies) {
    const Eigen::Vector3d up = body.in_root.linear().transpose() * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d lever = body.in_root * body.centre_of_gravity - sum.centre;
    sum.yaw_inertia += up.dot(body.inertia * up) + body.mass * lever.head<2>().squaredNorm();
  }
  return sum;
}

Eigen::Vector3d effective_centre(const RigidBodies& robot, const RobotParameters& parameters,
                                 const Eigen::Vector3d& from_urdf, RobotModel& model) {
  if (!parameters.centre_of_gravity) return from_urdf;
  const Vector3& given = *parameters.centre_of_gravity;
  Eigen::Vector3d centre(given[0], given[1], given[2]);
  const auto words = [](const Eigen::Vector3d& v) { return list({number(v.x()), number(v.y()), number(v.z())}); };
  if (!centre.allFinite()) {
    refuse(robot.source, "robot/centre_of_gravity", words(centre) + " m", "Give three finite numbers, or none");
  }
  if ((centre - from_urdf).norm() > kWorthNoting * model.wheel_base) {
    model.notes.push_back({RobotNote::Kind::kOverridden, "robot/centre_of_gravity",
                           words(centre) + " m holds, the URDF says " + words(from_urdf) + " m"});
  }
  return centre;
}

void read_masses(const RigidBodies& robot, const RobotParameters& parameters, RobotModel& model) {
  const MassSum sum = sum_of_masses(robot);
  model.mass = overridden("mass", "kg", parameters.mass, sum.mass, robot, model.notes);
  const Eigen::Vector3d centre = effective_centre(robot, parameters, sum.centre, model);
  model.centre_of_gravity_base = plain(centre);
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const WheelModel& wheel : model.wheels) {
    middle += Eigen::Vector2d(wheel.centre_base[0], wheel.centre_base[1]) / static_cast<double>(model.wheels.size());
  }
  model.yaw_inertia = model.mass / sum.mass * sum.yaw_inertia + model.mass * (centre.head<2>() - middle).squaredNorm();
}

/// The multiplier is that of equal loads.
void note_unequal_loads(const RobotParameters& parameters, RobotModel& model) {
  if (model.wheels.size() == 2 || parameters.wheel_base_multiplier) return;
  Eigen::Vector2d offset(model.centre_of_gravity_base[0], model.centre_of_gravity_base[1]);
  for (const WheelModel& wheel : model.wheels) {
    offset -= Eigen::Vector2d(wheel.centre_base[0], wheel.centre_base[1]) / static_cast<double>(model.wheels.size());
  }
  if (offset.norm() <= kCentral * model.wheel_base) return;
  model.notes.push_back({RobotNote::Kind::kSuspicious, "robot/wheel_base_multiplier",
                         "the centre of gravity lies " + number(offset.x()) + " m before and " + number(offset.y()) +
                             " m left of the middle of the wheels, the multiplier is that of equal loads"});
}

void read_imu(const RigidBodies& robot, const RobotParameters& parameters, RobotModel& model) {
  model.imu_link = imu_link_of(robot, parameters.imu_link, model.notes);
  model.imu_in_base = imu_pose(robot, model.imu_link, parameters, model.wheel_base, model.notes);
}

/// Without a missing mesh the robot may have nothing to stand on.
void check_missing_meshes(const RobotModel& model) {
  const std::vector<std::string>& missing = model.bodies->missing_meshes;
  if (!missing.empty() && !(lifting_deceleration(model) > 0)) throw RobotError(missing.front());
}

void check_finite(const RobotModel& model) {
  const auto all_finite = [](const WheelModel& w) {
    return std::isfinite(w.radius) && std::isfinite(w.width) && std::isfinite(w.inertia) && w.inertia > 0;
  };
  const bool finite = std::isfinite(model.wheel_base) && std::isfinite(model.wheel_base_multiplier) &&
                      std::isfinite(model.mass) && std::isfinite(model.yaw_inertia) &&
                      std::all_of(model.wheels.begin(), model.wheels.end(), all_finite) &&
                      std::all_of(model.casters.begin(), model.casters.end(), all_finite);
  if (!finite) {
    refuse(model.source, "<robot>", "masses, lengths or inertias that are beyond all numbers",
           "Give numbers of a robot that fits on this earth, in kg and m");
  }
}

/// Merges equal notes of several elements into one.
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

}  // namespace

const char* name_of(RobotNote::Kind kind) {
  constexpr std::array<const char*, 5> kNames{"assumed", "repaired", "ignored", "overridden", "suspicious"};
  return kNames.at(static_cast<std::size_t>(kind));
}

RobotModel read_robot(const RobotDescription& description, const RobotParameters& parameters) {
  const auto bodies = std::make_shared<RigidBodies>(read_rigid_bodies(description));
  RobotModel model;
  model.name = bodies->name;
  model.source = description.source;
  model.urdf = description.text;
  model.hash = model_hash(description.text, parameters);
  model.base_link = bodies->bodies[0].name;
  model.notes = bodies->notes;

  DriveTrain train = find_drive_train(*bodies, parameters, model.notes);
  release_followers(*bodies, train, model.notes);
  set_feet(*bodies, train, model.notes);
  assume_rotors(*bodies, train, model.notes);
  assume_springs(*bodies, train, model.notes);
  assume_differential(*bodies, train, model.notes);
  read_geometry(*bodies, parameters, train, model);
  read_joints(*bodies, parameters, train, model);
  read_masses(*bodies, parameters, model);
  note_unequal_loads(parameters, model);
  read_imu(*bodies, parameters, model);
  model.bodies = bodies;
  check_finite(model);
  check_missing_meshes(model);
  refuse_unheld_joints(model);
  note_suspicions(model);
  model.notes = merged(model.notes);
  return model;
}

}  // namespace robot_control
