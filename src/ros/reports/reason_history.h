#pragma once
/// A ReasonHistory collects the CommandReason bits of every cycle for a slower thread.

#include <cstdint>

#include "bus/latest_frames.h"
#include "signals/command_frame.h"

namespace robot_control {

class ReasonHistory {
 public:
  /// Returns the bits of all cycles after that of the last call up to `newest`, as far as the channel still has them.
  /// In a new run it returns those of `newest` alone.
  std::uint64_t collect(const FrameReader<CommandFrame>& channel, const CommandFrame& newest) noexcept {
    const bool same_run = newest.head.run == run_;
    std::uint64_t bits = newest.reasons;
    CommandFrame frame;
    for (std::uint64_t back = 1; same_run && back < kFrameSlots && cycle_ + back < newest.head.cycle; ++back) {
      if (channel.at(run_, newest.head.cycle - back, frame) == Lookup::kFrame) bits |= frame.reasons;
    }
    run_ = newest.head.run;
    cycle_ = newest.head.cycle;
    return bits;
  }

 private:
  std::uint64_t run_ = 0;
  std::uint64_t cycle_ = 0;
};

}  // namespace robot_control
