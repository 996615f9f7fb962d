#pragma once
/// ODrive CANSimple: the frames of one axis.
///
/// The 11-bit identifier is node (6 bits) << 5 | command (5 bits). Data are little-endian. A remote request under the
/// identifier of a message makes the axis send it now. A message has 8 bytes, as in the DBC files, or what its layout
/// uses if that is at most one byte. The torque of each cycle has the 4 bytes that it uses, which both firmwares
/// accept. Numbers are not checked: NaN in a frame is NaN in the message. Sources:
/// tests/fixtures/odrive-cansimple-*.dbc; ODrive firmware 0.5.6, communication/can/can_simple.cpp; ros_odrive,
/// can_simple_messages.hpp (0.6).

#include <cstdint>
#include <optional>

#include "drivers/line/can_frame.h"
#include "drivers/line/wire_layout.h"

namespace robot_control::odrive {

inline constexpr std::uint8_t kMaxNode = 0x3F;

inline std::uint8_t node_of(const can_frame& frame) noexcept {
  return static_cast<std::uint8_t>(frame.can_id >> 5U & kMaxNode);
}

inline std::uint8_t command_of(const can_frame& frame) noexcept {
  return static_cast<std::uint8_t>(frame.can_id & 0x1FU);
}

constexpr canid_t identifier(std::uint8_t node, std::uint8_t command) noexcept {
  return static_cast<canid_t>((node & kMaxNode) << 5U | command);
}

/// The command of a message and its direction.
struct Command {
  std::uint8_t number = 0;  ///< 5 bits
  bool from_axis = false;
  bool cyclic = false;  ///< sent in each cycle, without the bytes that its layout does not use
};

constexpr Command from_axis(std::uint8_t number) noexcept {
  return {.number = number, .from_axis = true};
}

constexpr Command to_axis(std::uint8_t number) noexcept {
  return {.number = number, .from_axis = false};
}

constexpr Command cyclic_to_axis(std::uint8_t number) noexcept {
  return {.number = number, .cyclic = true};
}

template <class Message>
can_frame encode(std::uint8_t node, const Message& message) noexcept {
  constexpr Command kCommand = Message::kCommand;
  constexpr bool kWhole = kCommand.from_axis || (!kCommand.cyclic && used_bytes<Message>() > 1);
  constexpr std::uint8_t kBytes = kWhole ? 8 : used_bytes<Message>();
  return word_frame(identifier(node, Message::kCommand.number), packed(message), kBytes);
}

/// Returns nothing if the frame is another message, or shorter than the layout.
template <class Message>
std::optional<Message> decode(const can_frame& frame) noexcept {
  if (!is_standard_data(frame) || command_of(frame) != Message::kCommand.number || frame.len < used_bytes<Message>()) {
    return std::nullopt;
  }
  return unpacked<Message>(data_word(frame));
}

/// Requests this message from the axis.
template <class Message>
can_frame request(std::uint8_t node) noexcept {
  static_assert(Message::kCommand.from_axis);
  return word_frame(identifier(node, Message::kCommand.number) | CAN_RTR_FLAG, 0, 0);
}

}  // namespace robot_control::odrive
