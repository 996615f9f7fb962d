#include "drivers/unitree_legged/legged_messages.h"

#include <type_traits>

#include "drivers/unitree/message_wire.h"

namespace robot_control::unitree {
namespace {

constexpr double kTorqueSteps = 256, kStiffnessSteps = 32, kDampingSteps = 16;

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
  imu_layout(wire, state.imu);
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
  battery_layout(wire, state.battery);
  wire.plain(state.foot_force);
  wire.plain(state.foot_force_estimate);
  wire.plain(state.tick);
  wire.plain(state.remote);
  wire.plain(state.reserve);
}

bool encode(const LowCmd& command, std::span<std::uint8_t, kCommandBytes> bytes) noexcept {
  return encode_message<Packing::kPacked>(command, bytes);
}

bool encode(const LowState& state, std::span<std::uint8_t, kStateBytes> bytes) noexcept {
  return encode_message<Packing::kPacked>(state, bytes);
}

Flaw decode(std::span<const std::uint8_t> bytes, LowCmd& command) noexcept {
  return decode_message<Packing::kPacked>(bytes, kCommandBytes, command);
}

Flaw decode(std::span<const std::uint8_t> bytes, LowState& state) noexcept {
  return decode_message<Packing::kPacked>(bytes, kStateBytes, state);
}

}  // namespace robot_control::unitree
