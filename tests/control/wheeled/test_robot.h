#pragma once
/// The robots of the unit tests, built in code.

#include <string>

#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// 12 kg on two wheels: a wheel sees 0.065 kg·m² straight, 0.045 turning, 0.005 lifted.
inline DriveTrain make_test_robot() {
  DriveTrain robot;
  robot.name = "test_robot";
  robot.source = "tests/control/wheeled/test_robot.h";
  robot.joints = {{.name = "left_wheel_joint", .child_link = "left_wheel", .effort_limit = 5, .velocity_limit = 30},
                  {.name = "right_wheel_joint", .child_link = "right_wheel", .effort_limit = 5, .velocity_limit = 30}};
  robot.wheels = {WheelModel{.joint = 0, .centre_base = {0, 0.25, 0}, .radius = 0.1, .width = 0.04, .inertia = 0.005},
                  WheelModel{.joint = 1,
                             .centre_base = {0, -0.25, 0},
                             .radius = 0.1,
                             .width = 0.04,
                             .inertia = 0.005,
                             .side = Side::kRight}};
  robot.wheel_base = 0.5;
  robot.mass = 12;
  robot.yaw_inertia = 0.5;
  robot.base_link = "base_link";
  return robot;
}

/// 24 kg on four such wheels, axles 0.4 m apart; positive joint velocity drives the left ones backward, as on AgileX's
/// robots. With an effective wheel base of 0.5·(1 + (0.4/0.5)²) = 0.82 m.
inline DriveTrain make_skid_steer() {
  DriveTrain robot = make_test_robot();
  const JointModel joint = robot.joints[0];
  robot.joints.assign(4, joint);
  robot.wheels.assign(4, robot.wheels[0]);
  for (std::size_t i = 0; i < 4; ++i) {
    const bool left = i < 2;
    const bool front = i % 2 == 0;
    robot.joints[i].name = std::string(front ? "front_" : "rear_") + (left ? "left_wheel" : "right_wheel");
    robot.wheels[i].joint = i;
    robot.wheels[i].side = left ? Side::kLeft : Side::kRight;
    robot.wheels[i].sign = left ? -1 : 1;
    robot.wheels[i].centre_base = {front ? 0.2 : -0.2, left ? 0.25 : -0.25, 0};
  }
  robot.wheel_base_multiplier = 1.64;
  robot.mass = 24;
  return robot;
}

}  // namespace robot_control
