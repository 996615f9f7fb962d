#pragma once
/// The layout of a message is stated once, as a tuple of fields; encoding and decoding both follow it.
///
/// A field holds the raw value r in `bits` bits from bit `bit` on, little-endian: an integer, or an IEEE 754 number of
/// 32 bits. The member has the value scale · r in SI units. Raw values exist in this file alone. Encoding rounds to the
/// nearest raw value and saturates at the ends of its range. NaN becomes 0 in an integer. Bits outside of all fields
/// are reserved: they are sent as 0 and ignored when received.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>

namespace robot_control {

enum class Wire : std::uint8_t { kUnsigned, kSigned, kFloat };

template <class Message, class Value>
struct WireField {
  Value Message::*member;
  unsigned bit;       ///< position of the lowest bit
  unsigned bits = 8;  ///< width, 1 … 64
  Wire type = Wire::kUnsigned;
  double scale = 1;  ///< SI value of one raw unit
};

template <class Message, class Value>
constexpr WireField<Message, Value> wire_float(Value Message::*member, unsigned bit, double scale = 1) {
  return {member, bit, 32, Wire::kFloat, scale};
}

template <class Message, class Value>
constexpr WireField<Message, Value> wire_unsigned(Value Message::*member, unsigned bit, unsigned bits) {
  return {member, bit, bits, Wire::kUnsigned, 1};
}

template <class Message, class Value>
constexpr WireField<Message, Value> wire_signed(Value Message::*member, unsigned bit, unsigned bits, double scale = 1) {
  return {member, bit, bits, Wire::kSigned, scale};
}

constexpr std::uint64_t low_bits(unsigned bits) noexcept {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

/// Reads the lowest `bits` bits of `raw` as a number in two's complement.
constexpr std::int64_t sign_extended(std::uint64_t raw, unsigned bits) noexcept {
  return static_cast<std::int64_t>(raw << (64 - bits)) >> (64 - bits);
}

/// Rounds to the nearest integer of `bits` ≤ 53 bits in two's complement, saturates, and takes NaN as 0.
inline std::int64_t saturated(double value, unsigned bits) noexcept {
  const double limit = std::ldexp(1.0, static_cast<int>(bits) - 1);
  if (std::isnan(value)) return 0;
  return static_cast<std::int64_t>(std::fmax(-limit, std::fmin(limit - 1, std::round(value))));
}

/// A finite number beyond the range becomes the largest of 32 bits, not infinity.
inline std::uint32_t float_bits(double value) noexcept {
  constexpr double kMax = std::numeric_limits<float>::max();
  if (std::isfinite(value)) value = std::fmax(-kMax, std::fmin(kMax, value));
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

template <class Message, class Value>
std::uint64_t raw_value(const WireField<Message, Value>& field, const Message& message) noexcept {
  const Value value = message.*field.member;
  if constexpr (std::is_floating_point_v<Value>) {
    return field.type == Wire::kFloat ? float_bits(value / field.scale)
                                      : static_cast<std::uint64_t>(saturated(value / field.scale, field.bits));
  } else {
    return static_cast<std::uint64_t>(value);
  }
}

template <class Message, class Value>
void set_value(const WireField<Message, Value>& field, std::uint64_t raw, Message& message) noexcept {
  if constexpr (std::is_floating_point_v<Value>) {
    const double number = field.type == Wire::kFloat ? double{std::bit_cast<float>(static_cast<std::uint32_t>(raw))}
                                                     : static_cast<double>(sign_extended(raw, field.bits));
    message.*field.member = field.scale * number;
  } else if (field.type == Wire::kSigned) {
    message.*field.member = static_cast<Value>(sign_extended(raw, field.bits));
  } else {
    message.*field.member = static_cast<Value>(raw);
  }
}

/// Returns the data of a message of at most 8 bytes; bit 0 is the lowest bit of byte 0.
template <class Message>
std::uint64_t packed(const Message& message) noexcept {
  std::uint64_t word = 0;
  std::apply(
      [&](const auto&... field) { ((word |= (raw_value(field, message) & low_bits(field.bits)) << field.bit), ...); },
      Message::layout());
  return word;
}

template <class Message>
Message unpacked(std::uint64_t word) noexcept {
  Message message;
  std::apply([&](const auto&... field) { (set_value(field, word >> field.bit & low_bits(field.bits), message), ...); },
             Message::layout());
  return message;
}

/// Returns the number of bytes up to the last one that the layout uses.
template <class Message>
constexpr std::uint8_t used_bytes() noexcept {
  unsigned end = 0;
  std::apply([&](const auto&... field) { ((end = field.bit + field.bits > end ? field.bit + field.bits : end), ...); },
             Message::layout());
  return static_cast<std::uint8_t>((end + 7) / 8);
}

}  // namespace robot_control
