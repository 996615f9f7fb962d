#pragma once
/// The frames of one Damiao motor (DM-J series) on CAN, with identifiers of 11 bits and 8 bytes of data.
///
///   to the motor's number     an order of drive/mit/mit_codec.h, or a Request. Each is answered
///   to 100h, 200h, 300h + it  orders of the other modes
///   to 7FFh                   number (2 bytes), operation, register, value (4 bytes), little-endian
///   to MST_ID, from it        Feedback, or the answer to a register, which repeats the request with the value
///
/// An answer to a register differs from Feedback by its number, operation and register alone. So it counts only while
/// this register is awaited, and is no Feedback otherwise. Sources: PyPI damiao-motor 1.0.6, core/motor.py;
/// cmjang/DM_Control_Python, DM_CAN.py.

#include <bit>
#include <cstdint>

#include "drivers/drive/mit/mit_codec.h"

namespace robot_control::damiao {

inline constexpr std::uint64_t kMaxNode = 15;  ///< Feedback holds four bits of it.
inline constexpr canid_t kRegisterId = 0x7FF;
inline constexpr double kTimeoutUnit = 50.0e-6;  ///< s, of the register kTimeout

using Request = MitRequest;

enum class Operation : std::uint8_t { kRead = 0x33, kWrite = 0x55, kStore = 0xAA, kRefresh = 0xCC };

/// Returns whether a motor answers this with its register.
inline bool is_access(Operation operation) noexcept {
  return operation == Operation::kRead || operation == Operation::kWrite || operation == Operation::kStore;
}

enum class Register : std::uint8_t {
  kTimeout = 9,         ///< units of kTimeoutUnit without an order until the motor is released; 0: never
  kControlMode = 10,    ///< 1: MIT
  kGear = 20,           ///< turns of the rotor per turn of the shaft, float
  kPositionRange = 21,  ///< PMAX, float
  kVelocityRange = 22,  ///< VMAX, float
  kTorqueRange = 23,    ///< TMAX, float
};

/// High nibble of the first byte of Feedback.
enum class State : std::uint8_t {
  kOff = 0,
  kOn = 1,
  kOverVoltage = 8,
  kUnderVoltage = 9,
  kOverCurrent = 0xA,
  kHotTransistors = 0xB,
  kHotRotor = 0xC,
  kCommunicationLost = 0xD,
  kOverload = 0xE,
};

struct Feedback {
  std::uint8_t node = 0;  ///< its lowest four bits
  State state = State::kOff;
  double position = 0;     ///< rad, of the shaft
  double velocity = 0;     ///< rad/s
  double torque = 0;       ///< N·m
  double transistors = 0;  ///< °C
  double rotor = 0;        ///< °C
};

struct RegisterAccess {
  std::uint16_t node = 0;
  Operation operation = Operation::kRead;
  Register number = Register::kTimeout;
  std::uint32_t value = 0;  ///< an integer, or the bits of a float

  double real() const noexcept { return double{std::bit_cast<float>(value)}; }
};

inline can_frame encode(std::uint64_t node, Request request) noexcept {
  return encode_request(node, request);
}

using robot_control::decode_request;

inline can_frame encode(canid_t id, const MitRanges& ranges, const Feedback& feedback) noexcept {
  const std::uint64_t word = static_cast<std::uint64_t>(feedback.state) << 60U |
                             static_cast<std::uint64_t>(feedback.node & 0xFU) << 56U |
                             mit_raw(feedback.position, -ranges.position, ranges.position, 16) << 40U |
                             mit_raw(feedback.velocity, -ranges.velocity, ranges.velocity, 12) << 28U |
                             mit_raw(feedback.torque, -ranges.torque, ranges.torque, 12) << 16U |
                             mit_raw(feedback.transistors, 0, 255, 8) << 8U | mit_raw(feedback.rotor, 0, 255, 8);
  return word_frame(id, __builtin_bswap64(word), 8);
}

/// The frame has 8 bytes.
inline Feedback decode_feedback(const can_frame& frame, const MitRanges& ranges) noexcept {
  const std::uint64_t word = __builtin_bswap64(data_word(frame));
  return {.node = static_cast<std::uint8_t>(word >> 56U & 0xFU),
          .state = static_cast<State>(word >> 60U),
          .position = mit_value(word >> 40U, -ranges.position, ranges.position, 16),
          .velocity = mit_value(word >> 28U, -ranges.velocity, ranges.velocity, 12),
          .torque = mit_value(word >> 16U, -ranges.torque, ranges.torque, 12),
          .transistors = static_cast<double>(word >> 8U & 0xFFU),
          .rotor = static_cast<double>(word & 0xFFU)};
}

inline can_frame encode(canid_t id, const RegisterAccess& access) noexcept {
  const std::uint64_t word = std::uint64_t{access.value} << 32U | static_cast<std::uint64_t>(access.number) << 24U |
                             static_cast<std::uint64_t>(access.operation) << 16U | access.node;
  return word_frame(id, word, 8);
}

/// The frame has 8 bytes.
inline RegisterAccess decode_register(const can_frame& frame) noexcept {
  const std::uint64_t word = data_word(frame);
  return {.node = static_cast<std::uint16_t>(word & 0xFFFFU),
          .operation = static_cast<Operation>(word >> 16U & 0xFFU),
          .number = static_cast<Register>(word >> 24U & 0xFFU),
          .value = static_cast<std::uint32_t>(word >> 32U)};
}

/// Returns whether a motor with this number obeys the frame: an order in any mode, or an access to its registers that
/// changes them.
inline bool commands(const can_frame& frame, std::uint64_t node) noexcept {
  if (frame.can_id == kRegisterId) {
    const RegisterAccess access = decode_register(frame);
    return access.node == node && access.operation != Operation::kRead && access.operation != Operation::kRefresh;
  }
  return frame.can_id == node || frame.can_id == 0x100 + node || frame.can_id == 0x200 + node ||
         frame.can_id == 0x300 + node;
}

}  // namespace robot_control::damiao
