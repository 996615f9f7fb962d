#pragma once
/// The 12 kg robot of the unit tests, built by hand: a wheel sees 0.065 kg·m² straight, 0.045 turning, 0.005 lifted.

#include "robot/robot_model.h"

namespace robot_control {

inline RobotModel make_test_robot() {
  RobotModel robot;
  robot.name = "test_robot";
  robot.source = "tests/control/test_robot.h";
  robot.joints = {{.name = "left_wheel_joint", .child_link = "left_wheel", .effort_limit = 5, .velocity_limit = 30},
                  {.name = "right_wheel_joint", .child_link = "right_wheel", .effort_limit = 5, .velocity_limit = 30}};
  robot.left = {.joint = 0, .centre_base = {0, 0.25, 0}, .radius = 0.1, .width = 0.04, .sign = 1, .inertia = 0.005};
  robot.right = {.joint = 1, .centre_base = {0, -0.25, 0}, .radius = 0.1, .width = 0.04, .sign = 1, .inertia = 0.005};
  robot.wheel_base = 0.5;
  robot.mass = 12;
  robot.yaw_inertia = 0.5;
  robot.base_link = "base_link";
  return robot;
}

}  // namespace robot_control
