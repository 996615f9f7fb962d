#pragma once
/// BoardParameters are the statements of the drive file about a board on a serial line (docs/board_protocol.md).

#include <string>
#include <vector>

#include "drivers/drive/serial_drive_file.h"
#include "drivers/drive_parameters.h"

namespace robot_control {

/// The greatest `max_silence`, in cycles. At 250 Hz a line that loses 6 % of the messages each way is silent for so
/// long once in 10⁵ hours.
inline constexpr std::uint64_t kMaxSilence = 12;

struct BoardLineParameters {
  std::string address;         ///< serial_port.h
  std::uint64_t bit_rate = 0;  ///< bit/s of a UART, as set in the board; 0: USB, which has none
  bool e_stop_input = false;   ///< The board has a contact of the emergency stop; a broken wire counts as pressed.
  std::uint64_t max_silence = kMaxSilence;  ///< cycles in a row without a new report

  /// The reaction of the board's watchdog, which the host cannot read.
  SilenceReaction on_silence = SilenceReaction::kUnknown;
};

inline Keys keys(BoardLineParameters& line) {
  return {
      {"address", &line.address},           {"bit_rate", &line.bit_rate, "bit/s", 0, 3000000, kOptional},
      {"e_stop_input", &line.e_stop_input}, {"max_silence", &line.max_silence, "cycles", 3, kMaxSilence, kOptional},
      {"on_silence", &line.on_silence},
  };
}

struct BoardWheelParameters {
  static constexpr const char *kPlace = "wheel", *kMotor = "wheel";

  std::string joint;           ///< name in the robot's model; the name of the block
  std::uint64_t wheel = 0;     ///< number on the board
  std::int64_t direction = 1;  ///< 1 or −1: the joint turns with the counts, or against them
  double counts_per_turn = 0;  ///< of the joint
  std::uint64_t counter_bits = 32;
  double torque_limit = 0;    ///< N·m, of the joint
  double velocity_limit = 0;  ///< rad/s, of the joint

  std::uint64_t place() const noexcept { return wheel; }
};

inline Keys keys(BoardWheelParameters& wheel) {
  return {
      {"wheel", &wheel.wheel, {}, 0, 3},
      {"direction", &wheel.direction, {}, -1, 1, kOptional},
      {"counts_per_turn", &wheel.counts_per_turn, "counts per turn of the joint", 1, 1.0e8},
      {"counter_bits", &wheel.counter_bits, {}, 16, 32, kOptional},
      {"torque_limit", &wheel.torque_limit, "N·m", 1.0e-3, 2000},
      {"velocity_limit", &wheel.velocity_limit, "rad/s", 0.01, 1000},
  };
}

struct BoardParameters {
  BoardLineParameters line;
  std::vector<BoardWheelParameters> wheels;  ///< in the order of the robot's joints
  bool takes_speeds = false;  ///< The board closes the loops of the wheels' speeds (JointMode::kDriveVelocity).
};

using BoardBlocks = FileOfJoints<SerialDriveFile<BoardLineParameters>, BoardWheelParameters>;

inline BoardParameters parameters_of(const BoardBlocks& file) {
  return {file.line, file.joints(), file.request().takes_speeds};
}

}  // namespace robot_control
