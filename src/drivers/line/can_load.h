#pragma once
/// The load of a bus is the share of its bit rate that a plan of frames takes, with the stuffed bits of each frame.
///
/// A classic frame of n data bytes has from the start bit to the checksum s = 34 + 8n bits (identifier of 11 bits) or
/// s = 54 + 8n bits (29 bits), which are stuffed: after five equal bits one opposite bit is inserted, which itself
/// begins the next sequence. At most ⌊(s − 1)/4⌋ bits are inserted. Without stuffing follow 10 bits (delimiters,
/// acknowledgement, end of frame) and 3 bits between frames. A remote request has no data, whatever its length says.
/// Source: ISO 11898-1, 10.4 and 10.5; Nolte, Hansson, Norström: "Minimizing CAN response-time jitter", RTAS 2002.
///
/// A frame of CAN FD has 17 or 35 bits up to the one that switches the rate, then 5 + 8n bits, both stuffed as above.
/// Then follow the count of stuffed bits (4) and a checksum of 17 bits, or of 21 beyond 16 bytes. They have a fixed
/// stuff bit at their beginning and after each four bits: 27 or 32 bits. The last 13 bits are those of a classic frame.
/// The bits between the switch and the last 13 have the rate of the data. Source: ISO 11898-1:2015, 10.4.2 and 10.5;
/// Linux, include/linux/can/length.h.

#include <optional>
#include <span>
#include <string>

#include "drivers/line/can_frame.h"

namespace robot_control {

/// Numbers of bits of a frame of CAN FD at its two rates.
struct FrameBits {
  unsigned arbitration = 0;
  unsigned data = 0;

  /// Returns the time in units of a bit of the arbitration. A data rate of 0 is that of the arbitration.
  constexpr double weighted(double bit_rate, double data_rate) const noexcept {
    return arbitration + data * (data_rate > 0 ? bit_rate / data_rate : 1);
  }
};

/// Returns the number of bits of the longest such classic frame, with the 3 bits between frames.
constexpr unsigned max_frame_bits(bool extended, unsigned data_bytes) noexcept {
  const unsigned stuffed = (extended ? 54 : 34) + 8 * data_bytes;
  return stuffed + (stuffed - 1) / 4 + 13;
}

/// The same of a frame of CAN FD, of a length that it may have.
constexpr FrameBits max_fd_bits(bool extended, unsigned data_bytes) noexcept {
  const unsigned head = extended ? 35 : 17;
  const unsigned stuffed = 5 + 8 * data_bytes;
  return {.arbitration = head + (head - 1) / 4 + 13, .data = stuffed + stuffed / 4 + (data_bytes > 16 ? 32 : 27)};
}

/// Returns the number of bits of exactly this classic frame, with the 3 bits between frames.
unsigned frame_bits(const can_frame& frame) noexcept;

/// The same of a frame of CAN FD. Without CANFD_BRS, all its bits have the rate of the arbitration.
FrameBits fd_frame_bits(const can_frame& frame) noexcept;

/// Frames of one length that are sent regularly. Remote requests count with 0 data bytes.
struct PlannedFrames {
  bool fd = false;
  bool extended = false;
  unsigned data_bytes = 8;
  double per_cycle = 0;   ///< frames in each cycle of the loop; 0.1: in every tenth
  double per_second = 0;  ///< frames that do not depend on the rate of the loop
};

inline constexpr double kMaxBusLoad =
    0.7;  ///< of the bit rate; the rest is for repeated frames and for delays below a cycle

/// Returns the share of the time, with worst-case stuffing. `rate` is the loop's in Hz, `bit_rate` and `data_rate` of
/// the data of CAN FD are in bit/s.
double bus_load(std::span<const PlannedFrames> plan, double rate, double bit_rate, double data_rate = 0) noexcept;

/// Returns nothing if the load is at most `max_load`. Otherwise returns the message of the refusal, which names the
/// largest whole robot.rate that fits. If none of at least `min_rate` fits, it names the bit rate that is needed.
std::optional<std::string> bus_load_problem(std::span<const PlannedFrames> plan, double rate, double bit_rate,
                                            double min_rate, double max_load = kMaxBusLoad, double data_rate = 0);

}  // namespace robot_control
