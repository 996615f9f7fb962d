#include "machine/wheeled/wheels/wheel_drive.h"

#include <algorithm>
#include <cmath>

#include "machine/description/wording.h"
#include "machine/gravity.h"
#include "machine/overrides.h"

namespace robot_control {
namespace {

constexpr double kPlaceholder = 100;
constexpr double kImplausibleVelocity = 1000;  // rad/s

bool is_placeholder(const BodyJoint& joint) {
  return joint.effort_limit == kPlaceholder && joint.velocity_limit == kPlaceholder;
}

void assume_rotor(const RigidBodies& robot, RollingBody& rolling, double least, std::vector<RobotNote>& notes) {
  WheelModel& wheel = rolling.wheel;
  if (wheel.inertia >= least) return;
  wheel.rotor_inertia = least - wheel.inertia;
  wheel.inertia = least;
  notes.push_back({RobotNote::Kind::kAssumed, joint_element(robot.bodies[rolling.body].joint.name),
                   "rotor inertia " + number(wheel.rotor_inertia) + " kg·m²: the wheel itself has " +
                       number(least - wheel.rotor_inertia) + " kg·m²"});
}

}  // namespace

DriveLimits drive_limits(const RigidBodies& robot, const RunningGear& gear, const RollingBody& wheel,
                         const DriveTrainParameters& parameters, std::vector<RobotNote>& notes) {
  const BodyJoint& joint = robot.bodies[wheel.body].joint;
  const auto note = [&](RobotNote::Kind kind, const std::string& text) {
    notes.push_back({kind, joint_element(joint.name), text});
  };
  const double share = total_mass(robot) / static_cast<double>(gear.wheels.size());
  DriveLimits limits{joint.effort_limit, joint.velocity_limit};
  if (limits.velocity >= kImplausibleVelocity || is_placeholder(joint)) limits.velocity = 0;
  const double speed = kLossSpeed / wheel.wheel.radius;
  const double turning = limits.velocity > 0 ? std::min(limits.velocity, speed) : speed;
  const double useful = share * kGravity * wheel.wheel.radius + joint.friction + joint.damping * turning;
  const bool implausible = joint.effort_limit > kImplausibleFactor * useful || is_placeholder(joint);
  if (!(limits.effort > 0) || implausible) {
    limits.effort = useful;
    if (!parameters.wheel_effort_limit) {
      note(RobotNote::Kind::kAssumed,
           (implausible ? "effort " + number(joint.effort_limit) + " N·m is a placeholder: " : "no effort limit: ") +
               number(useful) +
               " N·m assumed: what the tyre transmits at a friction of 1, plus the friction of the joint");
    }
  }
  if (!(limits.velocity > 0) && !parameters.wheel_velocity_limit) {
    note(RobotNote::Kind::kAssumed, joint.velocity_limit > 0 ? "velocity " + number(joint.velocity_limit) +
                                                                   " rad/s is a placeholder: no limit assumed"
                                                             : "no velocity limit");
  }
  limits.effort = overridden("wheel_effort_limit", "N·m", parameters.wheel_effort_limit, limits.effort, robot, notes);
  limits.velocity =
      overridden("wheel_velocity_limit", "rad/s", parameters.wheel_velocity_limit, limits.velocity, robot, notes);
  return limits;
}

void assume_rotors(const RigidBodies& robot, RunningGear& gear, std::vector<RobotNote>& notes) {
  const double mass = total_mass(robot);
  const auto wheels = static_cast<double>(gear.wheels.size());
  const double rolling = wheels + static_cast<double>(gear.casters.size());
  for (RollingBody& wheel : gear.wheels) {
    assume_rotor(robot, wheel, kDriveShare * mass / wheels * std::pow(wheel.wheel.radius, 2), notes);
  }
  for (RollingBody& caster : gear.casters) {
    assume_rotor(robot, caster, kCasterShare * mass / rolling * std::pow(caster.wheel.radius, 2), notes);
  }
}

}  // namespace robot_control
