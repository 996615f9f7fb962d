#include "drivers/mujoco/wheeled/true_wheels.h"

#include <algorithm>

#include "gate/wheeled/wheel_stop.h"
#include "machine/wheeled/drive_train.h"
#include "machine/wheeled/ground_points.h"

namespace robot_control {
namespace {

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

void add_errors(DriveTrain& robot, RigidBodies& bodies, const MujocoPlantParameters& parameters) {
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
    RigidBody& body = moved_by(bodies, joint.name);
    joint.friction *= 1 + parameters.wheel_friction_error;
    body.joint.friction *= 1 + parameters.wheel_friction_error;
    body.in_root.translation().y() += outwards;
  }
  robot.wheel_base *= 1 + parameters.wheel_base_error;
}

TrueWheel true_wheel(const WheelModel& wheel) {
  return {.joint = wheel.joint,
          .side = wheel.side == Side::kLeft ? 0u : 1u,
          .shape = ellipsoid_of(wheel),
          .inertia = wheel.inertia,
          .rotor_inertia = wheel.rotor_inertia,
          .omni = wheel.omni,
          .brake = {}};
}

}  // namespace

std::optional<TrueRobot> on_true_wheels(const MachineModel& described, const MujocoPlantParameters& parameters,
                                        double step) {
  const auto* const wheeled = dynamic_cast<const DriveTrain*>(&described);
  if (wheeled == nullptr) return std::nullopt;
  DriveTrain robot = as_described(*wheeled);
  auto bodies = std::make_shared<RigidBodies>(*robot.bodies);
  add_errors(robot, *bodies, parameters);
  load_base(robot, *bodies, parameters, robot.wheel_base);
  robot.bodies = std::move(bodies);

  TrueRobot result(robot);
  result.drive_wheels = robot.wheels.size();
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    result.wheels.push_back(true_wheel(robot.wheels[i]));
    result.wheels.back().brake = wheel_brake(robot, i, parameters.gear_ratio * parameters.motor_friction, step);
  }
  for (const WheelModel& caster : robot.casters) result.wheels.push_back(true_wheel(caster));
  return result;
}

}  // namespace robot_control
