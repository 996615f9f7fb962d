#pragma once
/// RoboclawParameters are the statements of the drive file about a RoboClaw on a serial line.

#include <string>
#include <vector>

#include "drivers/drive/serial_drive_file.h"
#include "drivers/drive_parameters.h"

namespace robot_control {

/// s without new counts, after which the driver and the monitor stop: the board's own timeout, its shortest one.
inline constexpr double kRoboclawSilence = 0.1;

struct RoboclawLineParameters {
  std::string address;                ///< serial_port.h
  std::uint64_t bit_rate = 0;         ///< bit/s of a UART, as set in the board; 0: USB
  std::uint64_t board_address = 128;  ///< of its packets

  /// The reaction of the board's serial timeout, which the host cannot read.
  SilenceReaction on_silence = SilenceReaction::kUnknown;
};

inline Keys keys(RoboclawLineParameters& line) {
  return {
      {"address", &line.address},
      {"bit_rate", &line.bit_rate, "bit/s", 0, 460800, kOptional},
      {"board_address", &line.board_address, {}, 128, 135, kOptional},
      {"on_silence", &line.on_silence},
  };
}

struct RoboclawWheelParameters {
  static constexpr const char *kPlace = "motor", *kMotor = "motor";

  std::string joint;           ///< name in the robot's model; the name of the block
  std::uint64_t motor = 1;     ///< 1: M1, 2: M2
  std::int64_t direction = 1;  ///< 1 or −1: the joint turns with the counts, or against them
  double counts_per_turn = 0;  ///< of the joint
  double velocity_limit = 0;   ///< rad/s, of the joint

  std::uint64_t place() const noexcept { return motor; }
};

inline Keys keys(RoboclawWheelParameters& wheel) {
  return {
      {"motor", &wheel.motor, {}, 1, 2},
      {"direction", &wheel.direction, {}, -1, 1, kOptional},
      {"counts_per_turn", &wheel.counts_per_turn, "counts per turn of the joint", 1, 1.0e8},
      {"velocity_limit", &wheel.velocity_limit, "rad/s", 0.01, 1000},
  };
}

struct RoboclawParameters {
  RoboclawLineParameters line;
  std::vector<RoboclawWheelParameters> wheels;  ///< two, in the order of the robot's joints
};

using RoboclawBlocks = FileOfJoints<SerialDriveFile<RoboclawLineParameters>, RoboclawWheelParameters>;

inline RoboclawParameters parameters_of(const RoboclawBlocks& file) {
  return {file.line, file.joints()};
}

}  // namespace robot_control
