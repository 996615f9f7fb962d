#pragma once
/// UnitreeLeggedParameters are the statements of the drive file about a Unitree Go1 at its low level.

#include <numbers>
#include <string>
#include <vector>

#include "drivers/drive/drive_file.h"
#include "drivers/drive_parameters.h"
#include "drivers/unitree_legged/legged_messages.h"

namespace robot_control {

/// Robots of the maker whose low level is UDP. A1 and Aliengo are known so that their refusal states the reason.
enum class LeggedRobot : std::uint8_t { kGo1, kA1, kAliengo };

inline std::vector<Word> words_of(LeggedRobot) {
  return {{"go1", LeggedRobot::kGo1}, {"a1", LeggedRobot::kA1}, {"aliengo", LeggedRobot::kAliengo}};
}

/// s without a new state, after which the driver stops: 20 ms from the last one on, in cycles of 2 ms. A line that
/// loses 5 % of the datagrams each way is silent for so long once in 1000 times 30 minutes.
inline constexpr double kLeggedSilence = 0.018;

struct UnitreeLeggedLine {
  LeggedRobot robot = LeggedRobot::kGo1;
  std::string address;                  ///< of the robot's low level: IPV4:PORT
  std::uint64_t port = 8080;            ///< of this computer
  double min_charge = 10;               ///< %, of the battery
  double max_silence = kLeggedSilence;  ///< s

  /// The reaction of the robot to a host that is silent, which cannot be read.
  SilenceReaction on_silence = SilenceReaction::kUnknown;
};

inline Keys keys(UnitreeLeggedLine& line) {
  return {
      {"robot", &line.robot},
      {"address", &line.address},
      {"port", &line.port, {}, 1024, 65535, kOptional},
      {"min_charge", &line.min_charge, "%", 0, 90, kOptional},
      {"max_silence", &line.max_silence, "s", 0.004, kLeggedSilence, kOptional},
      {"on_silence", &line.on_silence},
  };
}

struct UnitreeLeggedJoint {
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

inline Keys keys(UnitreeLeggedJoint& joint) {
  return {
      {"motor", &joint.motor, {}, 0, static_cast<double>(unitree::kRobotMotors - 1)},
      {"direction", &joint.direction, {}, -1, 1, kOptional},
      {"offset", &joint.offset, "rad", -std::numbers::pi, std::numbers::pi, kOptional},
      {"torque_limit", &joint.torque_limit, "N·m", 0.1, unitree::kMaxTorque},
      {"velocity_limit", &joint.velocity_limit, "rad/s", 0.1, 100},
      {"max_temperature", &joint.max_temperature, "°C", 20, 120, kOptional},
  };
}

struct UnitreeLeggedParameters {
  UnitreeLeggedLine line;
  std::vector<UnitreeLeggedJoint> joints;  ///< in the order of the robot's joints
};

}  // namespace robot_control
