#include "drivers/unitree_legged/legged_messages.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace robot_control::unitree {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::array<std::uint8_t, 3> kBegin{0xFE, 0xEF, kLowLevel};
constexpr std::size_t kCheckBytes = 4;

constexpr std::array<std::uint32_t, 256> check_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t remainder = i << 24U;
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder << 1U) ^ ((remainder >> 31U) != 0 ? 0x04C11DB7U : 0U);
    table[i] = remainder;
  }
  return table;
}

/// Writes the members to their bytes, in order.
struct Writer {
  std::uint8_t* at;
  bool exact = true;

  template <class Value>
  void plain(const Value& value) noexcept {
    std::memcpy(at, &value, sizeof value);
    at += sizeof value;
  }
  void real(float value, float /*maximum*/) noexcept {
    exact = exact && std::isfinite(value);
    plain(std::isfinite(value) ? value : 0.0F);
  }
  void percent(std::uint8_t value) noexcept { plain(value); }
  void fixed(double value, double steps) noexcept {
    const double scaled = std::isnan(value) ? 0 : std::round(value * steps);
    const double clamped = std::fmax(-32768, std::fmin(32767, scaled));
    exact = exact && !std::isnan(value) && clamped == scaled;
    plain(static_cast<std::int16_t>(clamped));
  }
};

/// Reads the members from their bytes, in order.
struct Reader {
  const std::uint8_t* at;
  bool exact = true;

  template <class Value>
  void plain(Value& value) noexcept {
    std::memcpy(&value, at, sizeof value);
    at += sizeof value;
  }
  void real(float& value, float maximum) noexcept {
    plain(value);
    exact = exact && std::abs(value) <= maximum;  // false for NaN
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

constexpr double kTorqueSteps = 256, kStiffnessSteps = 32, kDampingSteps = 16;
constexpr float kAnyNumber = 3.4e38F;

// Each layout is stated once, for both directions.
template <class Wire, class Head>
void head_layout(Wire& wire, Head& head) noexcept {
  wire.at += 2;
  wire.plain(head.level);
  wire.plain(head.reserve);
  wire.plain(head.serial_number);
  wire.plain(head.version);
  wire.plain(head.band_width);
}

template <class Wire, class Command>
requires std::is_same_v<std::remove_const_t<Command>, LowCmd>
void layout(Wire& wire, Command& command) noexcept {
  head_layout(wire, command.head);
  for (auto& motor : command.motors) {
    wire.plain(motor.mode);
    wire.real(motor.q, kAnyNumber);
    wire.real(motor.dq, kAnyNumber);
    wire.fixed(motor.tau, kTorqueSteps);
    wire.fixed(motor.kp, kStiffnessSteps);
    wire.fixed(motor.kd, kDampingSteps);
    wire.plain(motor.reserve);
  }
  wire.plain(command.bms);
  wire.plain(command.remote);
  wire.plain(command.reserve);
}

template <class Wire, class State>
requires std::is_same_v<std::remove_const_t<State>, LowState>
void layout(Wire& wire, State& state) noexcept {
  head_layout(wire, state.head);
  for (auto& value : state.imu.quaternion) wire.real(value, kMaxNumber);
  for (auto& value : state.imu.gyroscope) wire.real(value, kMaxNumber);
  for (auto& value : state.imu.accelerometer) wire.real(value, kMaxNumber);
  for (auto& value : state.imu.rpy) wire.real(value, kMaxNumber);
  wire.plain(state.imu.temperature);
  for (auto& motor : state.motors) {
    wire.plain(motor.mode);
    wire.real(motor.q, kMaxNumber);
    wire.real(motor.dq, kMaxNumber);
    wire.plain(motor.ddq);
    wire.fixed(motor.tau, kTorqueSteps);
    wire.real(motor.q_raw, kMaxNumber);
    wire.real(motor.dq_raw, kMaxNumber);
    wire.plain(motor.ddq_raw);
    wire.plain(motor.temperature);
    wire.plain(motor.reserve);
  }
  auto& battery = state.battery;
  wire.plain(battery.version_high);
  wire.plain(battery.version_low);
  wire.plain(battery.status);
  wire.percent(battery.charge);
  wire.plain(battery.current);
  wire.plain(battery.cycles);
  wire.plain(battery.bq_temperature);
  wire.plain(battery.mcu_temperature);
  wire.plain(battery.cells);
  wire.plain(state.foot_force);
  wire.plain(state.foot_force_estimate);
  wire.plain(state.tick);
  wire.plain(state.remote);
  wire.plain(state.reserve);
}

template <class Message>
bool encode_message(const Message& message, std::span<std::uint8_t> bytes) noexcept {
  Writer wire{.at = bytes.data()};
  std::memcpy(bytes.data(), kBegin.data(), 2);
  layout(wire, message);
  wire.plain(check_sum(bytes.first(bytes.size() - kCheckBytes)));
  return wire.exact;
}

template <class Message>
Flaw decode_message(std::span<const std::uint8_t> bytes, std::size_t size, Message& message) noexcept {
  if (bytes.size() != size) return Flaw::kLength;
  if (std::memcmp(bytes.data(), kBegin.data(), kBegin.size()) != 0) return Flaw::kHead;
  Message read;
  Reader wire{.at = bytes.data()};
  layout(wire, read);
  std::uint32_t check = 0;
  wire.plain(check);
  if (check != check_sum(bytes.first(size - kCheckBytes))) return Flaw::kCheck;
  if (!wire.exact) return Flaw::kValue;
  message = read;
  return Flaw::kNone;
}

}  // namespace

std::uint32_t check_sum(std::span<const std::uint8_t> bytes) noexcept {
  static constexpr std::array kTable = check_table();
  std::uint32_t sum = 0xFFFFFFFF;
  for (std::size_t word = 0; word + 4 <= bytes.size(); word += 4) {
    for (std::size_t byte = 4; byte-- > 0;) sum = (sum << 8U) ^ kTable[(sum >> 24U) ^ bytes[word + byte]];
  }
  return sum;
}

bool encode(const LowCmd& command, std::span<std::uint8_t, kCommandBytes> bytes) noexcept {
  return encode_message(command, bytes);
}

bool encode(const LowState& state, std::span<std::uint8_t, kStateBytes> bytes) noexcept {
  return encode_message(state, bytes);
}

Flaw decode(std::span<const std::uint8_t> bytes, LowCmd& command) noexcept {
  return decode_message(bytes, kCommandBytes, command);
}

Flaw decode(std::span<const std::uint8_t> bytes, LowState& state) noexcept {
  return decode_message(bytes, kStateBytes, state);
}

}  // namespace robot_control::unitree
