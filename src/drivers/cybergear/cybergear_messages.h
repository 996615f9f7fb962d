#pragma once
/// The frames of one CyberGear or RobStride motor on CAN, with identifiers of 29 bits and 8 bytes of data. The
/// identifier is type << 24 | 16 bits of data << 8 | number of the party that the frame is for.
///
///   1   to the motor   an order: torque in the identifier; position, velocity, stiffness and damping, 16 bits each,
///                      the highest byte first. Raw values as in drive/mit/mit_codec.h
///   2   from it        Feedback: in the identifier its number (bits 8–15), faults (16–21) and Mode (22–23); position,
///                      velocity, torque and tenths of °C. It answers types 1, 3, 4, 6 and 18
///   3, 4, 6  to it     enable; release, and with the first byte 1 clear its faults; set its zero
///   17, 18   to it     read or write a Parameter: index (2 bytes), value (from byte 4), little-endian. 17 is answered
///                      with 17: number of the motor in bits 8–15, in bits 16–23 a status other than 0 if it has none
///   21  from it        detailed faults, 4 bytes, little-endian
///
/// The 16 bits hold the number of the host where the table names none of them. An order has no room for it, so its
/// answer goes to the host that the motor stores. Answers therefore count by the number of the motor alone. The manual
/// of type 21 exchanges the numbers of host and motor, so both orders are taken. Sources: manual of the CyberGear
/// (belovictor/cybergear-docs, 4.1); PyPI python-cybergear 0.1.2, robstride-dynamics 0.0.1.

#include <bit>
#include <cstdint>
#include <optional>

#include "drivers/drive/mit/mit_codec.h"

namespace robot_control::cybergear {

inline constexpr std::uint64_t kMaxNode = 127;
inline constexpr std::uint64_t kHost = 0xFD;     ///< number of this program, beyond those of motors
inline constexpr double kTimeoutUnit = 50.0e-6;  ///< s, of Parameter::kTimeout

enum class Type : std::uint8_t {
  kIdentity = 0,
  kOrder = 1,
  kFeedback = 2,
  kEnable = 3,
  kRelease = 4,
  kSetZero = 6,
  kRead = 17,
  kWrite = 18,
  kFaults = 21,
};

/// Bits 22–23 of the identifier of Feedback.
enum class Mode : std::uint8_t { kReset = 0, kCalibration = 1, kRun = 2 };

enum class Parameter : std::uint16_t {
  kRunMode = 0x7005,      ///< 0: orders of type 1
  kTorqueLimit = 0x700B,  ///< N·m, float; as shipped the range of the torque
  kTimeout = 0x7028,      ///< units of kTimeoutUnit without an order until the motor is released; 0: never
};

struct Identifier {
  Type type = Type::kOrder;
  std::uint16_t data = 0;
  std::uint8_t target = 0;
};

struct Feedback {
  std::uint8_t node = 0;
  Mode mode = Mode::kReset;
  std::uint8_t faults = 0;
  double position = 0;     ///< rad, of the shaft
  double velocity = 0;     ///< rad/s
  double torque = 0;       ///< N·m
  double temperature = 0;  ///< °C
};

/// A request to read or write, or the answer to a read one.
struct ParameterAccess {
  Parameter index = Parameter::kRunMode;
  std::uint32_t value = 0;  ///< an integer, or the bits of a float

  double real() const noexcept { return double{std::bit_cast<float>(value)}; }
};

inline canid_t encode(const Identifier& id) noexcept {
  return CAN_EFF_FLAG | static_cast<canid_t>(id.type) << 24U | static_cast<canid_t>(id.data) << 8U | id.target;
}

/// Returns nothing if the frame has not 29 bits and 8 bytes.
inline std::optional<Identifier> identifier_of(const can_frame& frame) noexcept {
  if (!is_extended_data(frame) || frame.len != CAN_MAX_DLEN) return std::nullopt;
  return Identifier{.type = static_cast<Type>(frame.can_id >> 24U & 0x1FU),
                    .data = static_cast<std::uint16_t>(frame.can_id >> 8U & 0xFFFFU),
                    .target = static_cast<std::uint8_t>(frame.can_id & 0xFFU)};
}

/// Encodes a request without numbers; `first` is its first byte.
inline can_frame encode_request(Type type, std::uint8_t node, std::uint8_t first = 0) noexcept {
  return word_frame(encode({.type = type, .data = kHost, .target = node}), first, 8);
}

inline can_frame encode_order(std::uint8_t node, const MitRanges& ranges, const MitCommand& command) noexcept {
  const std::uint64_t word = mit_raw(command.position, -ranges.position, ranges.position, 16) << 48U |
                             mit_raw(command.velocity, -ranges.velocity, ranges.velocity, 16) << 32U |
                             mit_raw(command.stiffness, 0, ranges.stiffness, 16) << 16U |
                             mit_raw(command.damping, 0, ranges.damping, 16);
  const auto torque = static_cast<std::uint16_t>(mit_raw(command.torque, -ranges.torque, ranges.torque, 16));
  return word_frame(encode({.type = Type::kOrder, .data = torque, .target = node}), __builtin_bswap64(word), 8);
}

/// The frame is an order.
inline MitCommand decode_order(const can_frame& frame, const MitRanges& ranges) noexcept {
  const std::uint64_t word = __builtin_bswap64(data_word(frame));
  return {.position = mit_value(word >> 48U, -ranges.position, ranges.position, 16),
          .velocity = mit_value(word >> 32U, -ranges.velocity, ranges.velocity, 16),
          .stiffness = mit_value(word >> 16U, 0, ranges.stiffness, 16),
          .damping = mit_value(word, 0, ranges.damping, 16),
          .torque = mit_value(frame.can_id >> 8U, -ranges.torque, ranges.torque, 16)};
}

inline can_frame encode(std::uint8_t host, const MitRanges& ranges, const Feedback& feedback) noexcept {
  const std::uint64_t word = mit_raw(feedback.position, -ranges.position, ranges.position, 16) << 48U |
                             mit_raw(feedback.velocity, -ranges.velocity, ranges.velocity, 16) << 32U |
                             mit_raw(feedback.torque, -ranges.torque, ranges.torque, 16) << 16U |
                             mit_raw(feedback.temperature, 0, 6553.5, 16);
  const auto data = static_cast<std::uint16_t>(static_cast<unsigned>(feedback.mode) << 14U |
                                               (feedback.faults & 0x3FU) << 8U | feedback.node);
  return word_frame(encode({.type = Type::kFeedback, .data = data, .target = host}), __builtin_bswap64(word), 8);
}

/// The frame is a feedback.
inline Feedback decode_feedback(const can_frame& frame, const MitRanges& ranges) noexcept {
  const std::uint64_t word = __builtin_bswap64(data_word(frame));
  return {.node = static_cast<std::uint8_t>(frame.can_id >> 8U & 0xFFU),
          .mode = static_cast<Mode>(frame.can_id >> 22U & 3U),
          .faults = static_cast<std::uint8_t>(frame.can_id >> 16U & 0x3FU),
          .position = mit_value(word >> 48U, -ranges.position, ranges.position, 16),
          .velocity = mit_value(word >> 32U, -ranges.velocity, ranges.velocity, 16),
          .torque = mit_value(word >> 16U, -ranges.torque, ranges.torque, 16),
          .temperature = static_cast<double>(word & 0xFFFFU) / 10};
}

inline can_frame encode(const Identifier& id, const ParameterAccess& access) noexcept {
  return word_frame(encode(id), std::uint64_t{access.value} << 32U | static_cast<std::uint64_t>(access.index), 8);
}

inline ParameterAccess decode_parameter(const can_frame& frame) noexcept {
  const std::uint64_t word = data_word(frame);
  return {.index = static_cast<Parameter>(word & 0xFFFFU), .value = static_cast<std::uint32_t>(word >> 32U)};
}

/// Returns whether a motor with this number obeys the frame: it is for it, and neither reads nor answers.
inline bool commands(const Identifier& id, std::uint64_t node) noexcept {
  return id.target == node && id.type != Type::kIdentity && id.type != Type::kFeedback && id.type != Type::kRead &&
         id.type != Type::kFaults;
}

}  // namespace robot_control::cybergear
