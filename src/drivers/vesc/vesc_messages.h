#pragma once
/// The frames of one VESC on CAN.
///
/// The 29-bit identifier is command (8 bits) << 8 | controller (8 bits). Data are big-endian integers: bit 0 of a
/// layout is the lowest bit of the last byte. A message of another length is not accepted. Speeds and counts are those
/// of the electrical field: pole pairs times those of the motor. Source: VESC firmware 6, comm/comm_can.c,
/// motor/mcpwm_foc.c.

#include <numbers>
#include <optional>

#include "drivers/line/can_frame.h"
#include "drivers/line/wire_layout.h"

namespace robot_control::vesc {

inline constexpr std::uint8_t kMaxNode = 254;
inline constexpr std::uint8_t kEveryNode = 255;                  ///< All controllers obey an order to it.
inline constexpr double kCountsPerTurn = 6;                      ///< of the tachometer, per electrical turn
inline constexpr double kSpeedUnit = 2 * std::numbers::pi / 60;  ///< rad/s, of one ERPM

inline std::uint8_t node_of(const can_frame& frame) noexcept {
  return static_cast<std::uint8_t>(frame.can_id & 0xFFU);
}

inline std::uint32_t command_of(const can_frame& frame) noexcept {
  return (frame.can_id & CAN_EFF_MASK) >> 8U;
}

/// The motor gives a torque. Each order to it ends the one before, and feeds the drive's timeout.
struct SetCurrent {
  static constexpr std::uint32_t kCommand = 1;
  static constexpr std::uint8_t kBytes = 4;
  double current = 0;  ///< A; 0: the motor is released

  static constexpr auto layout() { return std::tuple{wire_signed(&SetCurrent::current, 0, 32, 0.001)}; }
};

/// The motor is slowed down. At rest it is released.
struct SetBrakeCurrent {
  static constexpr std::uint32_t kCommand = 2;
  static constexpr std::uint8_t kBytes = 4;
  double current = 0;  ///< A

  static constexpr auto layout() { return std::tuple{wire_signed(&SetBrakeCurrent::current, 0, 32, 0.001)}; }
};

/// The drive closes the loop of the speed. Below its s_pid_min_erpm it releases the motor.
struct SetSpeed {
  static constexpr std::uint32_t kCommand = 3;
  static constexpr std::uint8_t kBytes = 4;
  double speed = 0;  ///< rad/s

  static constexpr auto layout() { return std::tuple{wire_signed(&SetSpeed::speed, 0, 32, kSpeedUnit)}; }
};

/// The current is positive where the drive accelerates the motor, and negative where it brakes it. So the sign of the
/// torque is that of current · duty.
struct Status {
  static constexpr std::uint32_t kCommand = 9;
  static constexpr std::uint8_t kBytes = 8;
  double speed = 0;    ///< rad/s
  double current = 0;  ///< A
  double duty = 0;     ///< of the supply, −1 … 1

  static constexpr auto layout() {
    return std::tuple{wire_signed(&Status::speed, 32, 32, kSpeedUnit), wire_signed(&Status::current, 16, 16, 0.1),
                      wire_signed(&Status::duty, 0, 16, 0.001)};
  }
};

struct Status4 {
  static constexpr std::uint32_t kCommand = 16;
  static constexpr std::uint8_t kBytes = 8;
  double transistors = 0;    ///< °C
  double motor = 0;          ///< °C
  double input_current = 0;  ///< A, of the supply

  static constexpr auto layout() {
    return std::tuple{wire_signed(&Status4::transistors, 48, 16, 0.1), wire_signed(&Status4::motor, 32, 16, 0.1),
                      wire_signed(&Status4::input_current, 16, 16, 0.1)};
  }
};

struct Status5 {
  static constexpr std::uint32_t kCommand = 27;
  static constexpr std::uint8_t kBytes = 8;
  std::int32_t tachometer = 0;  ///< counts; overflows
  double voltage = 0;           ///< V, of the supply

  static constexpr auto layout() {
    return std::tuple{wire_signed(&Status5::tachometer, 32, 32), wire_signed(&Status5::voltage, 16, 16, 0.1)};
  }
};

/// Returns whether a controller obeys the command. It moves a motor by duty, current, brake current, speed and position
/// (0 … 4) and by relative and holding currents (10 … 13). A maker's tool is forwarded by another controller (5 … 8).
/// The others detect the motor (19), limit currents, speeds and battery (21 … 26, 29, 30), and shut down (31).
constexpr bool commands_motion(std::uint32_t command) noexcept {
  return command <= 8 || (command >= 10 && command <= 13) || command == 19 || (command >= 21 && command <= 26) ||
         (command >= 29 && command <= 31);
}

template <class Message>
can_frame encode(std::uint8_t node, const Message& message) noexcept {
  const std::uint64_t word = packed(message) << (64U - 8U * Message::kBytes);
  return word_frame(CAN_EFF_FLAG | Message::kCommand << 8U | node, __builtin_bswap64(word), Message::kBytes);
}

/// Returns nothing if the frame is another message.
template <class Message>
std::optional<Message> decode(const can_frame& frame) noexcept {
  if (!is_extended_data(frame) || command_of(frame) != Message::kCommand || frame.len != Message::kBytes) {
    return std::nullopt;
  }
  return unpacked<Message>(__builtin_bswap64(data_word(frame)) >> (64U - 8U * Message::kBytes));
}

}  // namespace robot_control::vesc
