#pragma once
/// The cycle that a consumer has processed last, and when it woke.

#include <cstdint>
#include <optional>

#include "bus/latest_frames.h"
#include "signals/frame_head.h"
#include "signals/sensor_frame.h"
#include "signals/trace.h"

namespace robot_control {

/// ns on the clock of the stamps; null in virtual time and in lockstep, where all timings are zero.
using Now = std::int64_t (*)();

/// A frame compared with the one that its consumer processed last.
enum class Arrival {
  kOld,     ///< the frame processed last, again
  kNext,    ///< a later cycle of the same run
  kNewRun,  ///< the first frame of another run
};

class CycleClock {
 public:
  explicit CycleClock(Now clock) noexcept : now_(clock) {}

  Arrival compare(const FrameHead& head) const noexcept {
    if (head.run != run_) return Arrival::kNewRun;
    return head.cycle > cycle_ ? Arrival::kNext : Arrival::kOld;
  }

  void accept(const FrameHead& head) noexcept {
    run_ = head.run;
    cycle_ = head.cycle;
  }

  std::int64_t now() const noexcept { return now_ == nullptr ? 0 : now_(); }

  CycleTiming timing(std::int64_t woke_ns, std::int64_t due_at_ns) const noexcept {
    if (now_ == nullptr) return {};
    return {.woke_ns = woke_ns - due_at_ns, .published_ns = now_() - due_at_ns};
  }
  CycleTiming timing(std::int64_t woke_ns, const SensorFrame& sensors) const noexcept {
    return timing(woke_ns, due_ns(sensors));
  }

  std::uint64_t run() const noexcept { return run_; }
  std::uint64_t cycle() const noexcept { return cycle_; }

 private:
  Now now_;
  std::uint64_t run_ = 0;
  std::uint64_t cycle_ = 0;
};

/// Returns whether `head` is of the run that the driver is in now, on a robot with this hash.
inline bool current(const FrameReader<SensorFrame>& sensors, const FrameHead& head, std::uint64_t robot_hash) noexcept {
  const auto* memory = sensors.memory();
  return memory != nullptr && memory->head.attached_run.load(std::memory_order_acquire) == head.run &&
         memory->head.robot_hash.load(std::memory_order_acquire) == robot_hash;
}

/// Cycle that an earlier process of this node published last in this run, frame or token; nothing: it was not here.
template <class Frame>
std::optional<std::uint64_t> published_before(const FrameWriter<Frame>& own, std::uint64_t run) noexcept {
  Frame last;
  const Lookup found = own.reader().newest(last);
  if ((found != Lookup::kFrame && found != Lookup::kToken) || last.head.run != run) return std::nullopt;
  return last.head.cycle;
}

}  // namespace robot_control
