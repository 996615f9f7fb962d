#include "drivers/mujoco/model/true_robot.h"

#include <algorithm>

#include "machine/bodies/link_inertia.h"

namespace robot_control {
namespace {

/// Returns the machine itself: its model holds no override that the plant must not have.
DriveTrain without_wheels(const MachineModel& described) {
  DriveTrain robot;
  static_cast<MachineModel&>(robot) = described;
  return robot;
}

DriveTrain as_described(const DriveTrain& described) {
  DriveTrainParameters names;
  for (const WheelModel& wheel : described.wheels) {
    auto& side = wheel.side == Side::kLeft ? names.left_wheel_joints : names.right_wheel_joints;
    side.push_back(described.joints[wheel.joint].name);
  }
  names.imu_link = described.imu_link;
  DriveTrain robot = read_drive_train({described.urdf, described.source}, names);
  for (std::size_t joint = 0; joint < robot.joints.size(); ++joint) {
    robot.joints[joint].effort_limit = described.joints[joint].effort_limit;
    robot.joints[joint].velocity_limit = described.joints[joint].velocity_limit;
  }
  return robot;
}

RigidBody& moved_by(RigidBodies& robot, const std::string& joint) {
  return *std::find_if(robot.bodies.begin() + 1, robot.bodies.end(),
                       [&](const RigidBody& body) { return body.joint.name == joint; });
}

void load(RigidBody& base, double mass, const Eigen::Vector3d& place) {
  const PointInertia both = sum({base.mass, base.centre_of_gravity, base.inertia}, {.mass = mass, .centre = place});
  base.mass = both.mass;
  base.centre_of_gravity = both.centre;
  base.inertia = both.inertia;
}

void load(DriveTrain& robot, double mass, const Vector3& place) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double& centre = robot.centre_of_gravity_base[axis];
    centre = (robot.mass * centre + mass * place[axis]) / (robot.mass + mass);
  }
  robot.mass += mass;
}

}  // namespace

DriveTrain true_robot(const MachineModel& described, const MujocoPlantParameters& parameters) {
  const auto* const wheeled = dynamic_cast<const DriveTrain*>(&described);
  DriveTrain robot = wheeled != nullptr ? as_described(*wheeled) : without_wheels(described);
  auto bodies = std::make_shared<RigidBodies>(*robot.bodies);
  const double widening = parameters.wheel_base_error * robot.wheel_base / 2;
  for (WheelModel& wheel : robot.wheels) {
    const bool left = wheel.side == Side::kLeft;
    const double outwards = left ? widening : -widening;
    const double rotor = parameters.gear_ratio * parameters.gear_ratio * parameters.rotor_inertia;
    wheel.radius *= 1 + (left ? parameters.left_radius_error : parameters.right_radius_error);
    wheel.centre_base[1] += outwards;
    wheel.rotor_inertia += rotor;
    wheel.inertia += rotor;
    JointModel& joint = robot.joints[wheel.joint];
    RigidBody& body = moved_by(*bodies, joint.name);
    joint.friction *= 1 + parameters.wheel_friction_error;
    body.joint.friction *= 1 + parameters.wheel_friction_error;
    body.in_root.translation().y() += outwards;
  }
  robot.wheel_base *= 1 + parameters.wheel_base_error;
  if (parameters.payload > 0) {
    const Vector3 place{parameters.payload_x, parameters.payload_y, parameters.payload_z};
    load(bodies->bodies[0], parameters.payload, {place[0], place[1], place[2]});
    load(robot, parameters.payload, place);
  }
  if (parameters.sensor_errors == ErrorLevel::kField) {
    const double off = parameters.centre_of_gravity_error * robot.wheel_base;
    RigidBody& base = bodies->bodies[0];
    for (const Eigen::Index axis : {0, 1}) base.centre_of_gravity[axis] += off * robot.mass / base.mass;
    for (const std::size_t axis : {0u, 1u}) robot.centre_of_gravity_base[axis] += off;
  }
  robot.bodies = std::move(bodies);
  return robot;
}

}  // namespace robot_control
