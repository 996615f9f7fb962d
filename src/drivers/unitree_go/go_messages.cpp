#include "drivers/unitree_go/go_messages.h"

#include <type_traits>

#include "drivers/unitree/message_wire.h"

namespace robot_control::unitree::go {
namespace {

constexpr std::size_t kStructBytes = 4;  // at a multiple of which a motor and the IMU begin

}

template <class Wire, class Command>
requires std::is_same_v<std::remove_const_t<Command>, LowCmd>
void layout(Wire& wire, Command& command) noexcept {
  head_layout(wire, command.head);
  for (auto& motor : command.motors) {
    wire.align(kStructBytes);
    wire.plain(motor.mode);
    wire.real(motor.q, kAnyNumber);
    wire.real(motor.dq, kAnyNumber);
    wire.single(motor.tau);
    wire.single(motor.kp);
    wire.single(motor.kd);
    wire.plain(motor.reserve);
  }
  wire.plain(command.bms);
  wire.plain(command.remote);
  wire.plain(command.led);
  wire.plain(command.fan);
  wire.plain(command.gpio);
  wire.plain(command.reserve);
}

template <class Wire, class State>
requires std::is_same_v<std::remove_const_t<State>, LowState>
void layout(Wire& wire, State& state) noexcept {
  head_layout(wire, state.head);
  wire.align(kStructBytes);
  imu_layout(wire, state.imu);
  for (auto& motor : state.motors) {
    wire.align(kStructBytes);
    wire.plain(motor.mode);
    wire.real(motor.q, kMaxNumber);
    wire.real(motor.dq, kMaxNumber);
    wire.real(motor.ddq, kAnyNumber);
    wire.single(motor.tau);
    wire.real(motor.q_raw, kAnyNumber);
    wire.real(motor.dq_raw, kAnyNumber);
    wire.real(motor.ddq_raw, kAnyNumber);
    wire.plain(motor.temperature);
    wire.plain(motor.lost);
    wire.plain(motor.reserve);
  }
  battery_layout(wire, state.battery);
  wire.plain(state.foot_force);
  wire.plain(state.foot_force_estimate);
  wire.plain(state.tick);
  wire.plain(state.remote);
  wire.plain(state.flags);
  wire.real(state.reel, kAnyNumber);
  wire.plain(state.board_temperature);
  wire.real(state.voltage, kMaxNumber);
  wire.real(state.current, kMaxNumber);
  wire.plain(state.fans);
  wire.plain(state.reserve);
}

namespace {

/// Passes over the members, and writes the gaps alone.
struct GapCleaner {
  std::uint8_t* begin;
  std::size_t at = 0;

  template <class Value>
  void plain(const Value& /*value*/) noexcept {
    align(alignof(Value));
    at += sizeof(Value);
  }
  void align(std::size_t size) noexcept {
    while (at % size != 0) begin[at++] = 0;
  }
  void real(float value, float /*maximum*/) noexcept { plain(value); }
  void single(double value) noexcept { plain(static_cast<float>(value)); }
  void percent(std::uint8_t value) noexcept { plain(value); }
};

template <class Message>
void clear_gaps(std::span<std::uint8_t> bytes) noexcept {
  const Message message;
  GapCleaner wire{.begin = bytes.data()};
  layout(wire, message);
  wire.plain(std::uint32_t{});  // the check sum
}

}  // namespace

bool encode(const LowCmd& command, std::span<std::uint8_t, kCommandBytes> bytes) noexcept {
  return encode_message<Packing::kAligned>(command, bytes);
}

bool encode(const LowState& state, std::span<std::uint8_t, kStateBytes> bytes) noexcept {
  return encode_message<Packing::kAligned>(state, bytes);
}

Flaw decode(std::span<const std::uint8_t> bytes, LowCmd& command) noexcept {
  return decode_message<Packing::kAligned>(bytes, kCommandBytes, command);
}

Flaw decode(std::span<const std::uint8_t> bytes, LowState& state) noexcept {
  return decode_message<Packing::kAligned>(bytes, kStateBytes, state);
}

void clear_gaps_of_command(std::span<std::uint8_t, kCommandBytes> bytes) noexcept {
  clear_gaps<LowCmd>(bytes);
}

void clear_gaps_of_state(std::span<std::uint8_t, kStateBytes> bytes) noexcept {
  clear_gaps<LowState>(bytes);
}

}  // namespace robot_control::unitree::go
