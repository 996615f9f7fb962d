#pragma once
/// The load of a bus is the share of its bit rate that a plan of frames takes, with the stuffed bits of each frame.
///
/// A classic frame of n data bytes has from the start bit to the checksum s = 34 + 8n bits (identifier of 11 bits) or
/// s = 54 + 8n bits (29 bits), which are stuffed: after five equal bits one opposite bit is inserted, which itself
/// begins the next sequence. At most ⌊(s − 1)/4⌋ bits are inserted. Without stuffing follow 10 bits (delimiters,
/// acknowledgement, end of frame) and 3 bits between frames. A remote request has no data, whatever its length says.
/// Source: ISO 11898-1, 10.4 and 10.5; Nolte, Hansson, Norström: "Minimizing CAN response-time jitter", RTAS 2002.

#include <optional>
#include <span>
#include <string>

#include "drivers/line/can_frame.h"

namespace robot_control {

/// Returns the number of bits of the longest such frame, with the 3 bits between frames.
constexpr unsigned max_frame_bits(bool extended, unsigned data_bytes) noexcept {
  const unsigned stuffed = (extended ? 54 : 34) + 8 * data_bytes;
  return stuffed + (stuffed - 1) / 4 + 13;
}

/// Returns the number of bits of exactly this frame, with the 3 bits between frames.
unsigned frame_bits(const can_frame& frame) noexcept;

/// Frames of one length that are sent regularly. Remote requests count with 0 data bytes.
struct PlannedFrames {
  bool extended = false;
  unsigned data_bytes = 8;
  double per_cycle = 0;   ///< frames in each cycle of the loop; 0.1: in every tenth
  double per_second = 0;  ///< frames that do not depend on the rate of the loop
};

inline constexpr double kMaxBusLoad =
    0.7;  ///< of the bit rate; the rest is for repeated frames and for delays below a cycle

/// Returns the share of the bit rate, with worst-case stuffing. `rate` is the loop's in Hz, `bit_rate` in bit/s.
double bus_load(std::span<const PlannedFrames> plan, double rate, double bit_rate) noexcept;

/// Returns nothing if the load is at most `max_load`. Otherwise returns the message of the refusal, which names the
/// largest whole robot.rate that fits. If none of at least `min_rate` fits, it names the bit rate that is needed.
std::optional<std::string> bus_load_problem(std::span<const PlannedFrames> plan, double rate, double bit_rate,
                                            double min_rate, double max_load = kMaxBusLoad);

}  // namespace robot_control
