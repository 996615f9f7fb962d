#include "machine/wheeled/wheel_suspicions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "machine/bodies/gravity_load.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/bodies/shape_support.h"
#include "machine/description/wording.h"
#include "machine/gravity.h"
#include "machine/suspicions.h"
#include "machine/wheeled/ground_points.h"
#include "machine/wheeled/tipping.h"
#include "machine/wheeled/wheels/drive_wheels.h"
#include "machine/wheeled/wheels/swivel.h"

namespace robot_control {
namespace {

void note(DriveTrain& robot, const std::string& element, const std::string& text) {
  robot.notes.push_back({RobotNote::Kind::kSuspicious, element, text});
}

void note_large_wheels(DriveTrain& robot) {
  for (const WheelModel& wheel : robot.wheels) {
    if (wheel.radius < kMaxWheelRadius) continue;
    note(robot, joint_element(robot.joints[wheel.joint].name),
         "a wheel radius of " + number(wheel.radius) +
             " m: check whether lengths are in millimetres; a URDF has metres");
  }
}

/// Returns the deceleration in m/s²; empty if a wheel's torque limit is neither the user's nor the file's.
std::optional<double> given_deceleration(const DriveTrain& robot) {
  double force = 0;
  for (const WheelModel& wheel : robot.wheels) {
    const JointModel& joint = robot.joints[wheel.joint];
    if (joint.effort_limit != robot.bodies->moved_by(joint.name)->joint.effort_limit) return {};
    force += joint.effort_limit / wheel.radius;
  }
  return std::min(kGravity, force / robot.mass);
}

void note_tipping(DriveTrain& robot) {
  const double limit = given_deceleration(robot).value_or(kUsualRamp);
  const double lifting = lifting_deceleration(robot);
  if (!(lifting > 0)) {
    // Springs give way until other parts stand on the ground than at the zero pose.
    if (std::ranges::any_of(robot.joints, [](const JointModel& joint) {
          return joint.prismatic && joint.role == JointRole::kPassive;
        })) {
      return;
    }
    note(robot, "<robot>",
         "no wheel, caster or foot within 3° of the ground supports it on one side of its centre of gravity (x " +
             length(robot.centre_of_gravity_base[0]) +
             " m): it tips over, or another part touches the ground. Check the positions of wheels and casters, and "
             "their lowest points");
    return;
  }
  if (lifting >= limit) return;
  note(robot, "<robot>",
       "its centre of gravity is so high, or so near to the edge of its support, that it tips over from " +
           number(lifting) + " m/s²; its own limit is " + number(limit) + " m/s²");
}

void note_weak_wheels(DriveTrain& robot) {
  double force = 0, effort = 0, friction = 0;
  for (const WheelModel& wheel : robot.wheels) {
    const JointModel& joint = robot.joints[wheel.joint];
    force += std::max(0.0, joint.effort_limit - joint.friction) / wheel.radius;
    effort = joint.effort_limit;
    friction = joint.friction;
  }
  const double acceleration = force / robot.mass;
  if (acceleration >= kMinAcceleration) return;
  note(robot, joint_element(robot.joints[robot.wheels.back().joint].name),
       "an effort limit of " + number(effort) + " N·m and a friction of " + number(friction) +
           " N·m: the wheels accelerate the robot by no more than " + number(acceleration) +
           " m/s². Check that the efforts refer to the joint, after the gear");
}

std::string limits_of(const JointModel& joint) {
  return number(joint.effort_limit) + " N·m and " +
         (joint.velocity_limit > 0 ? number(joint.velocity_limit) + " rad/s" : "no known speed");
}

bool differ(double a, double b) {
  return std::abs(a - b) > kSameLimit * std::max(a, b);
}

void note_limits(DriveTrain& robot) {
  const JointModel& first = robot.joints[robot.wheels.front().joint];
  for (const WheelModel& wheel : robot.wheels) {
    const JointModel& joint = robot.joints[wheel.joint];
    const double rim = joint.velocity_limit * wheel.radius;
    if (rim >= kFastRim) {
      note(robot, joint_element(joint.name),
           "a velocity limit of " + number(joint.velocity_limit) + " rad/s is " + number(rim) +
               " m/s at its rim: check whether it is in degrees per second or turns per minute; a URDF has rad/s");
    }
    if (differ(joint.effort_limit, first.effort_limit) || differ(joint.velocity_limit, first.velocity_limit)) {
      note(robot, joint_element(joint.name),
           "its limits are " + limits_of(joint) + ", those of " + first.name + " " + limits_of(first) +
               ": check whether this is intended; the weaker side limits both");
    }
  }
}

void note_far_root(DriveTrain& robot) {
  double nearest = std::numeric_limits<double>::infinity();
  Eigen::AlignedBox3d box;
  for (const WheelModel& wheel : robot.wheels) {
    nearest = std::min(nearest, Eigen::Vector3d(wheel.centre_base.data()).norm());
  }
  for (const RigidBody& body : robot.bodies->bodies) {
    for (const Shape& shape : body.shapes) box.extend(box_of(body, shape));
  }
  if (box.isEmpty() || nearest <= kMaxRootDistance * box.sizes().norm()) return;
  note(robot, link_element(robot.base_link),
       "it is " + number(nearest) +
           " m from the nearest wheel, farther than the size of the robot: odom and cmd_vel refer to this frame. If it "
           "is the world, remove it and its joint");
}

void note_caster_joints(DriveTrain& robot) {
  const RigidBodies& bodies = *robot.bodies;
  for (const WheelModel& caster : robot.casters) {
    const std::string& wheel = robot.joints[caster.joint].name;
    for (std::size_t i = bodies.moved_by(wheel)->parent; i != 0; i = bodies.bodies[i].parent) {
      const BodyJoint& joint = bodies.bodies[i].joint;
      if (joint.effort_limit == 0 || joint.spring_stiffness > 0 || !joint.mimicked.empty()) continue;
      if (is_swivel(bodies.bodies[i])) continue;
      note(robot, joint_element(joint.name),
           "it has an effort limit of " + number(joint.effort_limit) +
               (joint.type == JointType::kPrismatic ? " N" : " N·m") +
               ", but no motor holds it, because the wheel of " + wheel +
               " touches the ground as a caster. If it is an arm, move that wheel more than " +
               number(1000 * kCasterTolerance) + " mm above the ground");
    }
  }
}

void note_free_joints(DriveTrain& robot) {
  const RigidBodies& bodies = *robot.bodies;
  const auto carries_a_wheel = [&](std::size_t joint) {
    for (std::size_t i = joint; i < bodies.bodies.size(); ++i) {
      if (is_carried(bodies, i, joint) && rolling_body(robot, bodies.bodies[i]) != nullptr) return true;
    }
    return false;
  };
  for (std::size_t i = 1; i < bodies.bodies.size(); ++i) {
    const BodyJoint& joint = bodies.bodies[i].joint;
    if (joint.effort_limit > 0 || joint.spring_stiffness > 0 || !joint.mimicked.empty() || carries_a_wheel(i)) continue;
    note(robot, joint_element(joint.name), "no effort limit above zero: no motor holds it");
  }
}

}  // namespace

void note_suspicions(DriveTrain& robot) {
  note_large_wheels(robot);
  note_suspicious_bodies(robot);
  note_tipping(robot);
  note_weak_wheels(robot);
  note_limits(robot);
  note_far_root(robot);
  note_caster_joints(robot);
  note_free_joints(robot);
}

}  // namespace robot_control
