#pragma once
/// The order of the "MIT mode", in which a motor closes the impedance of its shaft:
///
///   τ = torque + stiffness · (position − q) + damping · (velocity − q̇)
///
/// Its five numbers are unsigned integers over a range, in 8 bytes, the highest bit first: position 16 bits, velocity,
/// stiffness, damping and torque 12 bits each. The raw value of x within its range is ⌊(x − min) · (2ⁿ − 1)/(max −
/// min)⌋. The clients of the makers round down, too, so that 0 becomes half a step below 0. Source: PyPI
/// damiao-motor 1.0.6, core/motor.py.
///
/// Seven bytes FFh and the byte of a MitRequest are no order, but a request.

#include <algorithm>
#include <cstdint>
#include <optional>

#include "drivers/line/can_frame.h"
#include "drivers/line/wire_layout.h"

namespace robot_control {

/// The fields of position, velocity and torque reach from −range to range, those of the gains from 0.
struct MitRanges {
  double position = 0;     ///< rad
  double velocity = 0;     ///< rad/s
  double torque = 0;       ///< N·m
  double stiffness = 500;  ///< N·m/rad
  double damping = 5;      ///< N·m·s/rad
};

struct MitCommand {
  double position = 0;   ///< rad, of the motor's shaft
  double velocity = 0;   ///< rad/s
  double stiffness = 0;  ///< N·m/rad
  double damping = 0;    ///< N·m·s/rad
  double torque = 0;     ///< N·m
};

/// Returns τ in N·m, for a shaft at `position` in rad with `velocity` in rad/s.
inline double mit_torque(const MitCommand& command, double position, double velocity) noexcept {
  return command.torque + command.stiffness * (command.position - position) +
         command.damping * (command.velocity - velocity);
}

/// `value` is not NaN.
inline std::uint64_t mit_raw(double value, double min, double max, unsigned bits) noexcept {
  return static_cast<std::uint64_t>((std::clamp(value, min, max) - min) * static_cast<double>(low_bits(bits)) /
                                    (max - min));
}

/// Returns the value of the lowest `bits` bits of `raw`.
inline double mit_value(std::uint64_t raw, double min, double max, unsigned bits) noexcept {
  return static_cast<double>(raw & low_bits(bits)) * (max - min) / static_cast<double>(low_bits(bits)) + min;
}

inline can_frame encode_mit(canid_t id, const MitRanges& ranges, const MitCommand& command) noexcept {
  const std::uint64_t word = mit_raw(command.position, -ranges.position, ranges.position, 16) << 48U |
                             mit_raw(command.velocity, -ranges.velocity, ranges.velocity, 12) << 36U |
                             mit_raw(command.stiffness, 0, ranges.stiffness, 12) << 24U |
                             mit_raw(command.damping, 0, ranges.damping, 12) << 12U |
                             mit_raw(command.torque, -ranges.torque, ranges.torque, 12);
  return word_frame(id, __builtin_bswap64(word), 8);
}

/// The frame has 8 bytes.
inline MitCommand decode_mit(const can_frame& frame, const MitRanges& ranges) noexcept {
  const std::uint64_t word = __builtin_bswap64(data_word(frame));
  return {.position = mit_value(word >> 48U, -ranges.position, ranges.position, 16),
          .velocity = mit_value(word >> 36U, -ranges.velocity, ranges.velocity, 12),
          .stiffness = mit_value(word >> 24U, 0, ranges.stiffness, 12),
          .damping = mit_value(word >> 12U, 0, ranges.damping, 12),
          .torque = mit_value(word, -ranges.torque, ranges.torque, 12)};
}

enum class MitRequest : std::uint8_t { kClear = 0xFB, kEnable = 0xFC, kRelease = 0xFD, kSetZero = 0xFE };

inline can_frame encode_request(std::uint64_t id, MitRequest request) noexcept {
  const std::uint64_t word = ~std::uint64_t{0} << 8U | static_cast<std::uint64_t>(request);
  return word_frame(static_cast<canid_t>(id), __builtin_bswap64(word), 8);
}

/// Returns nothing if the frame is another order.
inline std::optional<MitRequest> decode_request(const can_frame& frame) noexcept {
  const std::uint64_t word = __builtin_bswap64(data_word(frame));
  const std::uint64_t last = word & 0xFFU;
  if (word >> 8U != low_bits(56) || last < 0xFB || last > 0xFE) return std::nullopt;
  return static_cast<MitRequest>(last);
}

}  // namespace robot_control
