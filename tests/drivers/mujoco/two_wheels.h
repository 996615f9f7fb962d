#pragma once
/// Two wheels and a caster's swivel, which is enough of a robot for sensors and motors.

#include "machine/wheeled/drive_train.h"

namespace robot_control {

inline constexpr std::uint8_t kLeftWheel = 0;
inline constexpr std::uint8_t kRightWheel = 1;
inline constexpr std::uint8_t kSwivel = 2;

inline DriveTrain two_wheels() {
  DriveTrain robot;
  robot.joints.resize(3);
  robot.joints[kLeftWheel].effort_limit = robot.joints[kRightWheel].effort_limit = 3.5;
  robot.joints[kSwivel].role = JointRole::kPassive;
  robot.wheels.resize(2);
  robot.wheels[0].joint = kLeftWheel;
  robot.wheels[1].joint = kRightWheel;
  robot.wheels[1].side = Side::kRight;
  for (WheelModel& wheel : robot.wheels) wheel.inertia = 0.005;
  return robot;
}

}  // namespace robot_control
