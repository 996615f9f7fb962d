#pragma once
/// The four laws of a log, each with the state it has reached in its replay.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "gate/gate.h"
#include "log/replay/continuity.h"
#include "robots/laws.h"
#include "signals/trace.h"

namespace robot_control {

/// The frames of one channel that a law may have used: those of the last cycles, found by their checksum.
template <class Frame>
class FrameHistory {
 public:
  /// The log names the frame by `checksum`.
  void add(std::uint64_t checksum, const Frame& frame) noexcept {
    entries_[next_] = {true, checksum, frame};
    next_ = (next_ + 1) % kFrames;
  }

  /// Null: the history does not hold it.
  const Frame* find(std::uint64_t checksum) const noexcept {
    for (const Entry& entry : entries_) {
      if (entry.filled && entry.checksum == checksum) return &entry.frame;
    }
    return nullptr;
  }

  /// The newest frame of this cycle; null: there is none.
  const Frame* find(std::uint64_t run, std::uint64_t cycle) const noexcept {
    const Frame* found = nullptr;
    for (std::size_t i = 0; i < kFrames; ++i) {
      const Entry& entry = entries_[(next_ + i) % kFrames];
      if (entry.filled && entry.frame.head.run == run && entry.frame.head.cycle == cycle) found = &entry.frame;
    }
    return found;
  }

 private:
  static constexpr std::size_t kFrames = 32;  ///< a channel has 8 slots; a pause may fill more than one a cycle

  struct Entry {
    bool filled = false;
    std::uint64_t checksum = 0;
    Frame frame;
  };
  std::array<Entry, kFrames> entries_{};
  std::size_t next_ = 0;
};

/// Finds the sensor frame that a node used. A driver that paused or ended published its last frame again, with that
/// state.
inline bool sensors_of(const FrameHistory<SensorFrame>& published, const FrameHead& head, std::uint64_t checksum,
                       SensorFrame& out) {
  const SensorFrame* found = published.find(checksum);
  const bool again = found == nullptr;
  if (again) found = published.find(head.run, head.cycle);
  if (found == nullptr) return false;
  out = *found;
  if (!again) return true;
  for (const DriverState state : {DriverState::kPaused, DriverState::kEnded}) {
    out.driver_state = state;
    seal(out);
    if (out.head.checksum == checksum) return true;
  }
  return false;
}

struct GateReplica {
  Gate law;
  Continuity continuity;
  FrameHistory<SensorFrame> published{};
};

/// `output` is that of the last cycle, `kFrame` its place in the row. `published` are the frames, found by checksum.
template <class Law, auto kFrame, class Frame>
struct LawReplica {
  static Frame& frame_of(auto& trace) noexcept { return trace.*kFrame; }

  std::unique_ptr<Law> law;
  Continuity continuity;
  Frame output{};
  FrameHistory<Frame> published{};
};

}  // namespace robot_control
