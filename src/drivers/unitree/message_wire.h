#pragma once
/// The bytes of a message in the order of its members. A layout is a function `layout(wire, message)`. It hands each
/// member to a MessageWriter or to a MessageReader, so that it is stated once for both directions.
///
/// kPacked: there are no gaps. kAligned: each member lies as in a C struct, at a multiple of its size, and gaps are 0.

#include <bit>
#include <cmath>
#include <cstring>

#include "drivers/unitree/low_level.h"

namespace robot_control::unitree {

static_assert(std::endian::native == std::endian::little);

enum class Packing : std::uint8_t { kPacked, kAligned };

inline constexpr float kAnyNumber = 3.4e38F;
inline constexpr std::array<std::uint8_t, 3> kBegin{0xFE, 0xEF, kLowLevel};
inline constexpr std::size_t kCheckBytes = 4;

template <class Value>
constexpr std::size_t alignment_of(Packing packing) {
  return packing == Packing::kPacked ? 1 : alignof(Value);
}

/// Writes the members to their bytes.
template <Packing kPacking>
struct MessageWriter {
  std::uint8_t* begin;
  std::size_t at = 0;
  bool exact = true;  ///< no number was clamped or NaN

  /// Goes on at a multiple of `size`.
  void align(std::size_t size) noexcept {
    while (at % size != 0) begin[at++] = 0;
  }
  template <class Value>
  void plain(const Value& value) noexcept {
    align(alignment_of<Value>(kPacking));
    std::memcpy(begin + at, &value, sizeof value);
    at += sizeof value;
  }
  void real(float value, float /*maximum*/) noexcept {
    exact = exact && std::isfinite(value);
    plain(std::isfinite(value) ? value : 0.0F);
  }
  void single(double value) noexcept { real(static_cast<float>(value), kAnyNumber); }
  void percent(std::uint8_t value) noexcept { plain(value); }
  void fixed(double value, double steps) noexcept {
    const double scaled = std::isnan(value) ? 0 : std::round(value * steps);
    const double clamped = std::fmax(-32768, std::fmin(32767, scaled));
    exact = exact && !std::isnan(value) && clamped == scaled;
    plain(static_cast<std::int16_t>(clamped));
  }
};

/// Reads the members from their bytes.
template <Packing kPacking>
struct MessageReader {
  const std::uint8_t* begin;
  std::size_t at = 0;
  bool exact = true;  ///< all numbers lie within their range

  void align(std::size_t size) noexcept { at = (at + size - 1) / size * size; }
  template <class Value>
  void plain(Value& value) noexcept {
    align(alignment_of<Value>(kPacking));
    std::memcpy(&value, begin + at, sizeof value);
    at += sizeof value;
  }
  void real(float& value, float maximum) noexcept {
    plain(value);
    exact = exact && std::abs(value) <= maximum;  // false for NaN
  }
  void single(double& value) noexcept {
    float number = 0;
    real(number, kAnyNumber);
    value = double{number};
  }
  void percent(std::uint8_t& value) noexcept {
    plain(value);
    exact = exact && value <= 100;
  }
  void fixed(double& value, double steps) noexcept {
    std::int16_t raw = 0;
    plain(raw);
    value = raw / steps;
  }
};

template <class Wire, class Head>
void head_layout(Wire& wire, Head& head) noexcept {
  wire.at = 2;
  wire.plain(head.level);
  wire.plain(head.reserve);
  wire.plain(head.serial_number);
  wire.plain(head.version);
  wire.plain(head.band_width);
}

template <class Wire, class Imu>
void imu_layout(Wire& wire, Imu& imu) noexcept {
  for (auto& value : imu.quaternion) wire.real(value, kMaxNumber);
  for (auto& value : imu.gyroscope) wire.real(value, kMaxNumber);
  for (auto& value : imu.accelerometer) wire.real(value, kMaxNumber);
  for (auto& value : imu.rpy) wire.real(value, kMaxNumber);
  wire.plain(imu.temperature);
}

/// The cells of a battery have a type of their own on each robot.
template <class Wire, class Battery>
void battery_layout(Wire& wire, Battery& battery) noexcept {
  wire.plain(battery.version_high);
  wire.plain(battery.version_low);
  wire.plain(battery.status);
  wire.percent(battery.charge);
  wire.plain(battery.current);
  wire.plain(battery.cycles);
  wire.plain(battery.bq_temperature);
  wire.plain(battery.mcu_temperature);
  wire.plain(battery.cells);
}

/// Returns false if a number had to be clamped, or was NaN, which becomes 0.
template <Packing kPacking, class Message>
bool encode_message(const Message& message, std::span<std::uint8_t> bytes) noexcept {
  MessageWriter<kPacking> wire{.begin = bytes.data()};
  std::memcpy(bytes.data(), kBegin.data(), 2);
  layout(wire, message);
  wire.plain(check_sum(bytes.first(bytes.size() - kCheckBytes)));
  return wire.exact;
}

/// Changes the message only if the result is kNone.
template <Packing kPacking, class Message>
Flaw decode_message(std::span<const std::uint8_t> bytes, std::size_t size, Message& message) noexcept {
  if (bytes.size() != size) return Flaw::kLength;
  if (std::memcmp(bytes.data(), kBegin.data(), kBegin.size()) != 0) return Flaw::kHead;
  Message read;
  MessageReader<kPacking> wire{.begin = bytes.data()};
  layout(wire, read);
  std::uint32_t check = 0;
  wire.plain(check);
  if (check != check_sum(bytes.first(size - kCheckBytes))) return Flaw::kCheck;
  if (!wire.exact) return Flaw::kValue;
  message = read;
  return Flaw::kNone;
}

}  // namespace robot_control::unitree
