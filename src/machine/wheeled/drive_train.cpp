#include "machine/wheeled/drive_train.h"

#include <algorithm>
#include <cmath>

#include "machine/bodies/posed_bodies.h"
#include "machine/description/wording.h"
#include "machine/machine_reading.h"
#include "machine/model_hash.h"
#include "machine/overrides.h"
#include "machine/wheeled/bearing_joints.h"
#include "machine/wheeled/feet.h"
#include "machine/wheeled/tipping.h"
#include "machine/wheeled/wheel_suspicions.h"
#include "machine/wheeled/wheels/drive_wheels.h"
#include "machine/wheeled/wheels/suspension.h"
#include "machine/wheeled/wheels/wheel_drive.h"
#include "signals/formatted_text.h"

namespace robot_control {
namespace {

/// Returns one role per body; that of the root has no meaning.
///
///   kPassive  wheels of casters and the swivels above them, suspensions and rockers (all joints between the root and a
///             wheel), followers of a <mimic>, joints without an effort limit
///   kHeld     the others that the wheels do not drive: arms, lifts, grippers
std::vector<JointRole> joint_roles(const RigidBodies& robot, const RunningGear& gear) {
  std::vector<JointRole> roles(robot.bodies.size(), JointRole::kHeld);
  for (std::size_t i = 1; i < robot.bodies.size(); ++i) roles[i] = role_of(robot.bodies[i].joint);
  for (const auto* rolling : {&gear.wheels, &gear.casters}) {
    for (const RollingBody& wheel : *rolling) {
      for (std::size_t i = wheel.body; i != 0; i = robot.bodies[i].parent) roles[i] = JointRole::kPassive;
    }
  }
  for (const RollingBody& wheel : gear.wheels) roles[wheel.body] = JointRole::kDriven;
  return roles;
}

constexpr double kCentral = 0.05;  // share of the wheel base

/// A joint that may turn by more than this, in rad, has no end: "±1e16" and similar limits of wheels mean continuous.
constexpr double kEndless = 4 * 3.14159265358979323846;

std::uint64_t hash_of(const std::string& urdf, const DriveTrainParameters& parameters) {
  ModelHash hash;
  hash.add(urdf);
  hash.add(parameters.left_wheel_joints);
  hash.add(parameters.right_wheel_joints);
  hash.add(parameters.wheel_base);
  hash.add(parameters.wheel_base_multiplier);
  hash.add(parameters.wheel_radius);
  hash.add(parameters.left_wheel_radius_multiplier);
  hash.add(parameters.right_wheel_radius_multiplier);
  hash.add(parameters.wheel_effort_limit);
  hash.add(parameters.wheel_velocity_limit);
  hash.add(parameters.wheel_effort_rate);
  hash.add(static_cast<const MachineParameters&>(parameters));
  if (parameters.wheel_command == WheelCommand::kVelocity) {
    hash.add(std::string("velocity"));
    hash.add(std::optional(parameters.wheel_response_time));
  }
  return hash.value();
}

void read_geometry(const RigidBodies& robot, const DriveTrainParameters& parameters, RunningGear& gear,
                   DriveTrain& model) {
  for (RollingBody& wheel : gear.wheels) {
    wheel.wheel.radius =
        overridden("wheel_radius", "m", parameters.wheel_radius, wheel.wheel.radius, robot, model.notes);
    const bool left = wheel.wheel.side == Side::kLeft;
    wheel.wheel.radius *=
        overridden(left ? "left_wheel_radius_multiplier" : "right_wheel_radius_multiplier", "",
                   left ? parameters.left_wheel_radius_multiplier : parameters.right_wheel_radius_multiplier, 1, robot,
                   model.notes);
  }
  model.wheel_base =
      overridden("wheel_base", "m", parameters.wheel_base, wheel_base_of(gear.wheels), robot, model.notes);
  const double scrub = scrub_multiplier(gear.wheels);
  model.wheel_base_multiplier =
      overridden("wheel_base_multiplier", "", parameters.wheel_base_multiplier, scrub, robot, model.notes);
  if (gear.wheels.size() > 2 && !parameters.wheel_base_multiplier) {
    model.notes.push_back({RobotNote::Kind::kAssumed, "robot.wheel_base_multiplier",
                           number(scrub) + ", from the positions of the axles; measure it and set it"});
  }
}

void group_sides(DriveTrain& model) {
  JointGroup left{"left", {}}, right{"right", {}};
  for (const WheelModel& wheel : model.wheels) (wheel.side == Side::kLeft ? left : right).joints.push_back(wheel.joint);
  model.groups = {left, right};
}

/// Wheels turn without end, regardless of their joints' limits.
void free_wheels(DriveTrain& model) {
  for (const auto* rolling : {&model.wheels, &model.casters}) {
    for (const WheelModel& wheel : *rolling) {
      model.joints[wheel.joint].range.reset();
      model.joints[wheel.joint].rest_position = 0;
    }
  }
}

void read_joints(const RigidBodies& robot, const DriveTrainParameters& parameters, RunningGear& gear,
                 DriveTrain& model) {
  refuse_too_many_joints(robot);
  const std::vector<JointRole> roles = joint_roles(robot, gear);
  for (RollingBody& wheel : gear.wheels) {
    wheel.wheel.joint = model.joints.size();
    model.joints.push_back(joint_model(robot, robot.bodies[wheel.body], JointRole::kDriven));
    const DriveLimits limits = drive_limits(robot, gear, wheel, parameters, model.notes);
    model.joints.back().effort_limit = limits.effort;
    model.joints.back().velocity_limit = limits.velocity;
    const double given = overridden("wheel_effort_rate", "N·m/s", parameters.wheel_effort_rate, 0, robot, model.notes);
    model.joints.back().effort_rate = given > 0 ? given : limits.effort / kEffortRise;
    model.wheels.push_back(wheel.wheel);
  }
  for (const std::string& name : robot.moving_joints) {
    const auto body = static_cast<std::size_t>(robot.moved_by(name) - robot.bodies.data());
    if (roles[body] == JointRole::kDriven) continue;
    for (RollingBody& caster : gear.casters) {
      if (caster.body != body) continue;
      caster.wheel.joint = model.joints.size();
      model.casters.push_back(caster.wheel);
    }
    model.joints.push_back(joint_model(robot, robot.bodies[body], roles[body]));
  }
  free_wheels(model);
  group_sides(model);
  for (const auto* rolling : {&model.wheels, &model.casters}) {
    for (const WheelModel& wheel : *rolling) model.contacts.push_back(model.joints[wheel.joint].child_link);
  }
}

/// Returns the place of the centre of gravity from the middle of the axles, m.
Eigen::Vector2d centre_from_axles(const DriveTrain& model) {
  const Vector3 middle = middle_of_axles(model);
  return {model.centre_of_gravity_base[0] - middle[0], model.centre_of_gravity_base[1] - middle[1]};
}

void read_yaw_inertia(const RigidBodies& robot, DriveTrain& model) {
  const MassSum sum = sum_of_masses(robot);
  model.yaw_inertia = model.mass / sum.mass * sum.yaw_inertia + model.mass * centre_from_axles(model).squaredNorm();
}

/// A wheel of the robot on its wheels is accelerated by all wheels together, straight or turning. The factor admits a
/// robot of half the described mass.
void set_acceleration_limits(DriveTrain& model) {
  constexpr double kMassFactor = 2;
  for (const WheelModel& wheel : model.wheels) {
    const double inertia = std::min(straight_inertia(model, wheel), turning_inertia(model, wheel));
    JointModel& joint = model.joints[wheel.joint];
    joint.acceleration_limit = kMassFactor * joint.effort_limit / inertia;
  }
}

/// The multiplier is that of equal loads.
void note_unequal_loads(const DriveTrainParameters& parameters, DriveTrain& model) {
  if (model.wheels.size() == 2 || parameters.wheel_base_multiplier) return;
  const Eigen::Vector2d offset = centre_from_axles(model);
  if (offset.norm() <= kCentral * model.wheel_base) return;
  model.notes.push_back({RobotNote::Kind::kSuspicious, "robot.wheel_base_multiplier",
                         "the centre of gravity lies " + length(offset.x()) + " m before and " + length(offset.y()) +
                             " m left of the middle of the wheels, but the multiplier assumes equal loads"});
}

/// Without a missing mesh the robot may have nothing to stand on.
void check_missing_meshes(const DriveTrain& model) {
  const std::vector<std::string>& missing = model.bodies->missing_meshes;
  if (!missing.empty() && !(lifting_deceleration(model) > 0)) throw RobotError(missing.front());
}

void check_finite(const DriveTrain& model) {
  const auto all_finite = [](const WheelModel& w) {
    return std::isfinite(w.radius) && std::isfinite(w.width) && std::isfinite(w.inertia) && w.inertia > 0;
  };
  const bool finite = std::isfinite(model.wheel_base) && std::isfinite(model.wheel_base_multiplier) &&
                      std::isfinite(model.mass) && std::isfinite(model.yaw_inertia) &&
                      std::all_of(model.wheels.begin(), model.wheels.end(), all_finite) &&
                      std::all_of(model.casters.begin(), model.casters.end(), all_finite);
  if (!finite) {
    refuse(model.source, "<robot>", "masses, lengths or inertias overflow", "Set masses in kg and lengths in m");
  }
}

}  // namespace

double DriveTrain::wheels_beside(const WheelModel& wheel) const noexcept {
  return static_cast<double>(std::ranges::count(wheels, wheel.side, &WheelModel::side));
}

Vector3 middle_of_axles(const DriveTrain& robot) noexcept {
  Vector3 middle{};
  for (std::size_t axis = 0; axis < middle.size(); ++axis) {
    for (const WheelModel& wheel : robot.wheels) middle[axis] += wheel.centre_base[axis];
    if (!robot.wheels.empty()) middle[axis] /= static_cast<double>(robot.wheels.size());
  }
  return middle;
}

double straight_inertia(const DriveTrain& robot, const WheelModel& wheel) noexcept {
  return wheel.inertia + 0.5 * robot.mass * wheel.radius * wheel.radius / robot.wheels_beside(wheel);
}

double turning_inertia(const DriveTrain& robot, const WheelModel& wheel) noexcept {
  const double levers = wheel.radius * wheel.radius / (robot.wheel_base * robot.effective_wheel_base());
  return wheel.inertia + 2 * robot.yaw_inertia * levers / robot.wheels_beside(wheel);
}

std::string DriveTrain::parts() const {
  const auto names_of = [this](Side side) {
    std::string names;
    for (const WheelModel& wheel : wheels) {
      if (wheel.side == side) names.append(names.empty() ? "" : ", ").append(joints[wheel.joint].name);
    }
    return names;
  };
  std::string text = "left wheels " + names_of(Side::kLeft) + ", right wheels " + names_of(Side::kRight) +
                     formatted(", radius %.4g m, wheel base %.4g m", wheels.front().radius, wheel_base);
  if (wheel_base_multiplier != 1) text += formatted(" (effective %.4g m)", effective_wheel_base());
  return text;
}

const DriveTrain& drive_train_of(const MachineModel& machine) {
  const auto* const wheeled = dynamic_cast<const DriveTrain*>(&machine);
  if (wheeled == nullptr) throw RobotError(machine.source + ": this robot has no drive wheels");
  return *wheeled;
}

DriveTrain read_drive_train(const RobotDescription& description, const DriveTrainParameters& parameters) {
  const auto bodies = std::make_shared<RigidBodies>(read_rigid_bodies(description, kEndless));
  DriveTrain model;
  static_cast<MachineModel&>(model) = named_machine(description, *bodies);
  model.hash = hash_of(description.text, parameters);
  model.wheel_command = parameters.wheel_command;
  model.wheel_response_time = parameters.wheel_response_time;

  RunningGear gear = find_running_gear(*bodies, parameters, model.notes);
  release_followers(*bodies, gear, model.notes);
  set_feet(*bodies, gear, model.notes);
  assume_rotors(*bodies, gear, model.notes);
  assume_springs(*bodies, gear, model.notes);
  assume_differential(*bodies, gear, model.notes);
  read_geometry(*bodies, parameters, gear, model);
  read_joints(*bodies, parameters, gear, model);
  note_resting_places(model);
  const RigidBodies at_rest = resting(*bodies, model.joints);
  read_masses(at_rest, parameters, model.wheel_base, model);
  read_yaw_inertia(at_rest, model);
  note_unequal_loads(parameters, model);
  read_imu(at_rest, parameters, model.wheel_base, model);
  model.bodies = bodies;
  set_acceleration_limits(model);
  check_finite(model);
  check_missing_meshes(model);
  refuse_unheld_joints(model);
  note_suspicions(model);
  model.notes = merged(model.notes);
  return model;
}

}  // namespace robot_control
