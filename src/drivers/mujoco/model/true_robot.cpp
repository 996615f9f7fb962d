#include "drivers/mujoco/model/true_robot.h"

#include <algorithm>
#include <optional>

#include "drivers/mujoco/wheeled/true_wheels.h"
#include "machine/bodies/link_inertia.h"

namespace robot_control {
namespace {

constexpr double kRotorAcceleration = 200;  // rad/s² or m/s²
constexpr double kMaxRotor = 1;             // m²: an inertia over the robot's mass

void load(RigidBody& base, double mass, const Eigen::Vector3d& place) {
  const PointInertia both = sum({base.mass, base.centre_of_gravity, base.inertia}, {.mass = mass, .centre = place});
  base.mass = both.mass;
  base.centre_of_gravity = both.centre;
  base.inertia = both.inertia;
}

void load(MachineModel& robot, double mass, const Vector3& place) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double& centre = robot.centre_of_gravity_base[axis];
    centre = (robot.mass * centre + mass * place[axis]) / (robot.mass + mass);
  }
  robot.mass += mass;
}

/// Takes the machine as it is: its model holds no override that the plant must not have.
TrueRobot without_wheels(const MachineModel& described, const MujocoPlantParameters& parameters) {
  TrueRobot robot(described);
  auto bodies = std::make_shared<RigidBodies>(*robot.bodies);
  load_base(robot, *bodies, parameters, 0);
  robot.bodies = std::move(bodies);
  return robot;
}

}  // namespace

void load_base(MachineModel& robot, RigidBodies& bodies, const MujocoPlantParameters& parameters, double wheel_base) {
  if (parameters.payload > 0) {
    const Vector3 place{parameters.payload_x, parameters.payload_y, parameters.payload_z};
    load(bodies.bodies[0], parameters.payload, {place[0], place[1], place[2]});
    load(robot, parameters.payload, place);
  }
  if (parameters.sensor_errors == ErrorLevel::kField) {
    const double off = parameters.centre_of_gravity_error * wheel_base;
    RigidBody& base = bodies.bodies[0];
    for (const Eigen::Index axis : {0, 1}) base.centre_of_gravity[axis] += off * robot.mass / base.mass;
    for (const std::size_t axis : {0u, 1u}) robot.centre_of_gravity_base[axis] += off;
  }
}

TrueRobot true_robot(const MachineModel& described, const MujocoPlantParameters& parameters, double step) {
  std::optional<TrueRobot> wheeled = on_true_wheels(described, parameters, step);
  TrueRobot robot = wheeled ? *std::move(wheeled) : without_wheels(described, parameters);
  for (JointModel& joint : robot.joints) {
    if (joint.role == JointRole::kHeld)
      joint.rotor_inertia = std::min(joint.effort_limit / kRotorAcceleration, robot.mass * kMaxRotor);
  }
  return robot;
}

const TrueWheel* wheel_of(const TrueRobot& robot, const RigidBody& body) {
  const auto wheel = std::ranges::find_if(
      robot.wheels, [&](const TrueWheel& each) { return robot.joints[each.joint].child_link == body.name; });
  return wheel == robot.wheels.end() ? nullptr : &*wheel;
}

}  // namespace robot_control
