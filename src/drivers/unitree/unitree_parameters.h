#pragma once
/// UnitreeParameters are the statements of the drive file about a legged robot of Unitree at its low level. Robot is
/// Go1 (unitree_legged/go1.h) or another one with the same members.

#include <numbers>
#include <string>
#include <vector>

#include "drivers/drive/drive_file.h"
#include "drivers/drive/drive_status.h"
#include "drivers/drive_parameters.h"
#include "drivers/unitree/low_level.h"

namespace robot_control {

/// Why a driver must not run although states come; kNone: it may.
struct LegObstacle {
  DriveCause cause = DriveCause::kNone;
  const char* subject = "";
  double found = 0;
  double expected = 0;
  bool is_fault = false;  ///< false: a driver that starts waits until the obstacle is gone
};

template <class Robot>
struct UnitreeJoint {
  static constexpr const char *kPlace = "motor", *kMotor = "motor";

  std::string joint;            ///< name in the robot's model; the name of the block
  std::uint64_t motor = 0;      ///< index in the messages
  std::int64_t direction = 1;   ///< 1 or −1: the joint turns with the motor, or against it
  double offset = 0;            ///< rad, of the joint where the motor is at 0
  double torque_limit = 0;      ///< N·m
  double velocity_limit = 0;    ///< rad/s
  double max_temperature = 80;  ///< °C

  std::uint64_t place() const noexcept { return motor; }
};

template <class Robot>
Keys keys(UnitreeJoint<Robot>& joint) {
  return {
      {"motor", &joint.motor, {}, 0, static_cast<double>(unitree::kRobotMotors - 1)},
      {"direction", &joint.direction, {}, -1, 1, kOptional},
      {"offset", &joint.offset, "rad", -std::numbers::pi, std::numbers::pi, kOptional},
      {"torque_limit", &joint.torque_limit, "N·m", 0.1, Robot::kMaxTorque},
      {"velocity_limit", &joint.velocity_limit, "rad/s", 0.1, 100},
      {"max_temperature", &joint.max_temperature, "°C", 20, 120, kOptional},
  };
}

template <class Robot>
struct UnitreeParameters {
  typename Robot::Line line;
  std::vector<UnitreeJoint<Robot>> joints;  ///< in the order of the robot's joints
};

}  // namespace robot_control
