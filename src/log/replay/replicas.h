#pragma once
/// The four laws of a log, each with the state it has reached in its replay.

#include <memory>

#include "gate/gate.h"
#include "log/replay/continuity.h"
#include "log/replay/frame_history.h"
#include "robots/laws.h"
#include "signals/trace.h"

namespace robot_control {

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
