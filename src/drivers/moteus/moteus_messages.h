#pragma once
/// The frames of one moteus controller of mjbots on CAN FD. The identifier is source << 8 | target, of 7 bits each, and
/// has 29 bits beyond 7FFh. Bit 15 requests a reply. The data are subframes, each about `count` registers in a row:
///
///   00h | type << 2 | count   writes the registers; their values follow
///   10h | type << 2 | count   reads them
///   20h | type << 2 | count   replies; their values follow
///   50h                       nothing: padding at the end, to a length of CAN FD
///
/// The number of the first register follows the first byte. Before it comes `count`, if the two bits are 0. A number
/// beyond 7Fh has two bytes of 7 bits, the lowest first, and bit 7 of the first one is set. The type is 0, 1 or 2 of
/// integers of 8, 16 or 32 bits, and 3 of IEEE 754 numbers of 32 bits, little-endian. The lowest integer means NaN.
///
/// A controller replies with the subframes that it was requested, in their order. Other replies are none.
///
/// Sources: mjbots/moteus, docs/protocol/can.md and registers.md; PyPI moteus 1.1.1, moteus/multiplex.py.

#include <cstdint>
#include <numbers>
#include <optional>

#include "drivers/drive/mit/mit_codec.h"

namespace robot_control::moteus {

inline constexpr double kTurn = 2 * std::numbers::pi;  ///< rad
inline constexpr std::uint64_t kBroadcast = 127;       ///< every controller takes frames for this number

/// Register 000h. Others are ways to the mode position (2, 3, 4), or modes that no request here orders.
enum class Mode : std::int8_t { kStopped = 0, kFault = 1, kPosition = 10, kTimeout = 11 };

/// A request to stop clears an error and ends a timeout. An order in the mode position ends after `timeout`, and no
/// limit of a trajectory delays its targets. Both request a reply, with its details or without.
struct Request {
  Mode mode = Mode::kStopped;
  MitCommand command{};
  double max_torque = 0;  ///< N·m
  double timeout = 0;     ///< s
  bool details = false;
};

struct Reply {
  double mode = 0;         ///< Mode
  double position = 0;     ///< rad, of the output
  double velocity = 0;     ///< rad/s
  double torque = 0;       ///< N·m
  double voltage = 0;      ///< V
  double temperature = 0;  ///< °C, of the board
  double fault = 0;        ///< its code; from 96 on a limit that acts
  bool details = false;

  double home = 0;         ///< its position is relative to nothing (0), one turn of the rotor (1), or the output (2)
  double map_version = 0;  ///< of its registers
  double proportional = 0, integral = 0, derivative = 0;  ///< N·m, parts of the torque of the last order
};

/// `gains` hold the stiffness and the damping of which an order has a part.
can_frame encode(std::uint64_t node, const MitRanges& gains, Request request) noexcept;
can_frame encode(std::uint64_t node, Reply reply) noexcept;

/// Return nothing if the frame is not for this controller, or not from it for this program, or of another layout.
std::optional<Request> decode_request(const can_frame& frame, std::uint64_t node, const MitRanges& gains) noexcept;
std::optional<Reply> decode_reply(const can_frame& frame, std::uint64_t node) noexcept;

/// Returns whether a controller with this number obeys the frame: it does not begin with a read. Streams of the maker's
/// tool count as well.
bool commands(const can_frame& frame, std::uint64_t node) noexcept;

}  // namespace robot_control::moteus
