#pragma once
/// The order of the "MIT mode", in which a motor closes the impedance of its shaft:
///
///   τ = torque + stiffness · (position − q) + damping · (velocity − q̇)
///
/// Its five numbers are unsigned integers over a range, in 8 bytes, the highest bit first: position 16 bits, velocity,
/// stiffness, damping and torque 12 bits each. The raw value of x within its range is ⌊(x − min) · (2ⁿ − 1)/(max −
/// min)⌋. The clients of the makers round down, too, so that 0 becomes half a step below 0. Source: PyPI
/// damiao-motor 1.0.6, core/motor.py.

#include <algorithm>
#include <cstdint>

#include "drivers/line/can_frame.h"
#include "drivers/line/wire_layout.h"

namespace robot_control {

/// The fields of position, velocity and torque reach from −range to range.
struct MitRanges {
  static constexpr double kStiffness = 500, kDamping = 5;  ///< N·m/rad, N·m·s/rad, from 0

  double position = 0;  ///< rad
  double velocity = 0;  ///< rad/s
  double torque = 0;    ///< N·m
};

struct MitCommand {
  double position = 0;   ///< rad, of the motor's shaft
  double velocity = 0;   ///< rad/s
  double stiffness = 0;  ///< N·m/rad
  double damping = 0;    ///< N·m·s/rad
  double torque = 0;     ///< N·m
};

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
                             mit_raw(command.stiffness, 0, MitRanges::kStiffness, 12) << 24U |
                             mit_raw(command.damping, 0, MitRanges::kDamping, 12) << 12U |
                             mit_raw(command.torque, -ranges.torque, ranges.torque, 12);
  return word_frame(id, __builtin_bswap64(word), 8);
}

/// The frame has 8 bytes.
inline MitCommand decode_mit(const can_frame& frame, const MitRanges& ranges) noexcept {
  const std::uint64_t word = __builtin_bswap64(data_word(frame));
  return {.position = mit_value(word >> 48U, -ranges.position, ranges.position, 16),
          .velocity = mit_value(word >> 36U, -ranges.velocity, ranges.velocity, 12),
          .stiffness = mit_value(word >> 24U, 0, MitRanges::kStiffness, 12),
          .damping = mit_value(word >> 12U, 0, MitRanges::kDamping, 12),
          .torque = mit_value(word, -ranges.torque, ranges.torque, 12)};
}

}  // namespace robot_control
