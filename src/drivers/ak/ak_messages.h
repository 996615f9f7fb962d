#pragma once
/// The frames of one AK motor of T-Motor (CubeMars) on CAN, in the protocol of the mini-cheetah.
///
///   to the motor's number  an order or a request of drive/mit/mit_codec.h. Each is answered
///   to 0, from it          its number (1 byte), position (16 bits), velocity and torque (12 bits each), the highest
///                          byte first; of newer firmware also a temperature and an Error
///
/// Firmware of the servo mode, and newer MIT firmware, obeys identifiers of 29 bits: packet << 8 | number. Sources:
/// PyPI mini-cheetah-motor-driver-socketcan 0.4.3, motor_driver/canmotorlib.py; neurobionics/TMotorCANControl,
/// src/TMotorCANControl/mit_can.py.

#include <cstdint>
#include <optional>

#include "drivers/drive/mit/mit_codec.h"

namespace robot_control::ak {

inline constexpr canid_t kAnswers = 0;
inline constexpr unsigned kLastPacket = 9;  ///< of those that a motor obeys under 29 bits

enum class Error : std::uint8_t {
  kNone = 0,
  kHot = 1,
  kOverCurrent = 2,
  kOverVoltage = 3,
  kUnderVoltage = 4,
  kEncoder = 5,
  kUnbalanced = 6,  ///< phase currents
};

struct Reply {
  std::uint8_t node = 0;
  double position = 0;  ///< rad, of the shaft
  double velocity = 0;  ///< rad/s
  double torque = 0;    ///< N·m, from the current

  struct Health {
    std::uint8_t temperature = 0;  ///< raw
    Error error = Error::kNone;
  };
  std::optional<Health> health{};
};

inline can_frame encode(const MitRanges& ranges, const Reply& reply) noexcept {
  const Reply::Health health = reply.health.value_or(Reply::Health{});
  const std::uint64_t word = static_cast<std::uint64_t>(reply.node) << 56U |
                             mit_raw(reply.position, -ranges.position, ranges.position, 16) << 40U |
                             mit_raw(reply.velocity, -ranges.velocity, ranges.velocity, 12) << 28U |
                             mit_raw(reply.torque, -ranges.torque, ranges.torque, 12) << 16U |
                             static_cast<std::uint64_t>(health.temperature) << 8U |
                             static_cast<std::uint64_t>(health.error);
  return word_frame(kAnswers, __builtin_bswap64(word), reply.health ? 8 : 6);
}

/// Returns nothing if the frame is no reply.
inline std::optional<Reply> decode_reply(const can_frame& frame, const MitRanges& ranges) noexcept {
  if (frame.can_id != kAnswers || (frame.len != 6 && frame.len != 8)) return std::nullopt;
  const std::uint64_t word = __builtin_bswap64(data_word(frame));
  Reply reply{.node = static_cast<std::uint8_t>(word >> 56U),
              .position = mit_value(word >> 40U, -ranges.position, ranges.position, 16),
              .velocity = mit_value(word >> 28U, -ranges.velocity, ranges.velocity, 12),
              .torque = mit_value(word >> 16U, -ranges.torque, ranges.torque, 12)};
  if (frame.len == 8) {
    reply.health = {.temperature = static_cast<std::uint8_t>(word >> 8U & 0xFFU),
                    .error = static_cast<Error>(word & 0xFFU)};
  }
  return reply;
}

/// Returns whether a motor with this number obeys the frame.
inline bool commands(const can_frame& frame, std::uint64_t node) noexcept {
  if (is_standard_data(frame)) return frame.can_id == node;
  const canid_t id = frame.can_id & CAN_EFF_MASK;
  return is_extended_data(frame) && (id & 0xFFU) == node && id >> 8U <= kLastPacket;
}

}  // namespace robot_control::ak
