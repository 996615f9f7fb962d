#include "drivers/mujoco/motors/brake_limits.h"

#include <algorithm>

#include "drivers/driver.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

constexpr double kHoldSpeed = 0.03;  // rad/s or m/s

}  // namespace

double inertia_of(const TrueRobot& robot, std::size_t index, const MujocoPlantParameters& parameters) {
  if (index < robot.drive_wheels) return robot.wheels[index].inertia;
  if (robot.joints[index].role == JointRole::kHeld) return robot.joints[index].rotor_inertia;
  const RigidBody& body = *robot.bodies->moved_by(robot.joints[index].name);
  const double rotor =
      parameters.gear_ratio * parameters.gear_ratio * parameters.rotor_inertia + robot.joints[index].rotor_inertia;
  if (robot.joints[index].prismatic) return body.mass + rotor;
  const Eigen::Vector3d& axis = body.joint.axis;
  const double lever = body.centre_of_gravity.cross(axis).squaredNorm();
  return axis.dot(body.inertia * axis) + body.mass * lever + rotor;
}

Brake brake_of(const TrueRobot& robot, std::size_t index, const MujocoPlantParameters& parameters, double step) {
  const JointModel& joint = robot.joints[index];
  const double inertia = inertia_of(robot, index, parameters);
  Brake brake = {.effort = joint.effort_limit,
                 .hold_effort = joint.effort_limit,
                 .damping = 0.4 * inertia / step,
                 .stiffness = 0.06 * inertia / (step * step),
                 .hold_speed = kHoldSpeed};
  if (joint.role == JointRole::kHeld) return brake;
  if (index < robot.drive_wheels) brake = robot.wheels[index].brake;
  if (parameters.brake_effort) {
    brake.effort = brake.hold_effort = std::min(*parameters.brake_effort, joint.effort_limit);
  }
  brake.damping = parameters.brake_damping.value_or(brake.damping);
  brake.stiffness = parameters.brake_stiffness.value_or(brake.stiffness);
  brake.hold_speed = parameters.brake_hold_speed.value_or(brake.hold_speed);
  check_brake(brake, joint.name, inertia, step);
  return brake;
}

void check_brake(const Brake& brake, const std::string& joint, double inertia, double step) {
  const auto check = [&](const std::string& name, double value, double limit, const std::string& unit) {
    if (value > 0 && value <= limit) return;
    throw DriverError("mujoco_plant." + name + " = " + number(value) + " " + unit + ": joint " + joint +
                      " has an inertia of only " + number(inertia) + " kg·m², a time step of " + number(step * 1000) +
                      " ms allows values above 0 up to " + number(limit) + " " + unit +
                      ". Set such a value, or remove it.");
  };
  check("brake_damping", brake.damping, 0.5 * inertia / step, "N·m·s/rad");
  check("brake_stiffness", brake.stiffness, 0.5 * inertia / (step * step), "N·m/rad");
}

}  // namespace robot_control
