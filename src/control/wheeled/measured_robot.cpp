#include "control/wheeled/measured_robot.h"

namespace robot_control {

DriveTrain measured_robot(DriveTrain robot, const FeedForwardParameters& measured) {
  robot.mass = measured.mass.value_or(robot.mass);
  robot.yaw_inertia = measured.yaw_inertia.value_or(robot.yaw_inertia);
  for (WheelModel& wheel : robot.wheels) {
    JointModel& joint = robot.joints[wheel.joint];
    wheel.inertia = measured.wheel_inertia.value_or(wheel.inertia);
    joint.damping = measured.wheel_damping.value_or(joint.damping);
    joint.friction = measured.wheel_friction.value_or(joint.friction);
  }
  return robot;
}

}  // namespace robot_control
