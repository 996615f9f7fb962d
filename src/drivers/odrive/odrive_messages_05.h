#pragma once
/// Messages that the firmware 0.5 alone has, or has in another layout than 0.6.

#include "drivers/odrive/odrive_messages.h"

namespace robot_control::odrive::v05 {

struct Heartbeat {
  static constexpr Command kCommand = from_axis(0x01);
  std::uint32_t error = 0;  ///< bits of odrive_errors.h
  AxisState state = AxisState::kUndefined;
  bool motor_error = false;
  bool encoder_error = false;
  bool controller_error = false;
  bool trajectory_done = false;

  static constexpr auto layout() {
    return std::tuple{wire_unsigned(&Heartbeat::error, 0, 32),
                      wire_unsigned(&Heartbeat::state, 32, 8),
                      wire_unsigned(&Heartbeat::motor_error, 40, 1),
                      wire_unsigned(&Heartbeat::encoder_error, 48, 1),
                      wire_unsigned(&Heartbeat::controller_error, 56, 1),
                      wire_unsigned(&Heartbeat::trajectory_done, 63, 1)};
  }
};

/// The firmware sends 64 bits; the DBC file describes the lower 32 of them.
struct MotorError {
  static constexpr Command kCommand = from_axis(0x03);
  std::uint64_t error = 0;

  static constexpr auto layout() { return std::tuple{wire_unsigned(&MotorError::error, 0, 64)}; }
};

struct EncoderError {
  static constexpr Command kCommand = from_axis(0x04);
  std::uint32_t error = 0;

  static constexpr auto layout() { return std::tuple{wire_unsigned(&EncoderError::error, 0, 32)}; }
};

struct ClearErrors {
  static constexpr Command kCommand = to_axis(0x18);

  static constexpr auto layout() { return std::tuple{}; }
};

struct SetLinearCount {
  static constexpr Command kCommand = to_axis(0x19);
  std::int32_t position = 0;  ///< counts

  static constexpr auto layout() { return std::tuple{wire_signed(&SetLinearCount::position, 0, 32)}; }
};

struct ControllerError {
  static constexpr Command kCommand = from_axis(0x1D);
  std::uint32_t error = 0;

  static constexpr auto layout() { return std::tuple{wire_unsigned(&ControllerError::error, 0, 32)}; }
};

}  // namespace robot_control::odrive::v05
