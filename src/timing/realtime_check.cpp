#include "timing/realtime_check.h"

namespace robot_control {

void RealtimeCheck::add(const RealtimeReading& reading) noexcept {
  if (!began_ns_) began_ns_ = reading.time_ns;
  if (reading.time_ns - *began_ns_ < kStartNs) return;
  if (count_ == 0) {
    first_ = reading;
  } else {
    const RealtimeReading& before = newest();
    const std::uint64_t switches = reading.counters.voluntary_switches - before.counters.voluntary_switches;
    // The wait that had begun at the reading before may have switched after it.
    const std::uint64_t waits = reading.waits_after - before.waits_before + 1;
    blocks_ += switches > waits ? switches - waits : 0;
  }
  kept_[count_++ % kReadings] = {reading, blocks_};
}

RealtimeCounts RealtimeCheck::recent() const noexcept {
  if (count_ == 0) return {};
  const Kept& oldest = kept_[count_ <= kReadings ? 0 : count_ % kReadings];
  return between(oldest.reading, newest(), blocks_ - oldest.blocks);
}

RealtimeCounts RealtimeCheck::between(const RealtimeReading& from, const RealtimeReading& to,
                                      std::uint64_t blocks) noexcept {
  const ThreadCounters& a = from.counters;
  const ThreadCounters& b = to.counters;
  RealtimeCounts counts{.page_faults = b.page_faults - a.page_faults,
                        .blocks = blocks,
                        .voluntary_switches = b.voluntary_switches - a.voluntary_switches,
                        .forced_switches = b.forced_switches - a.forced_switches};
  if (a.run_queue_ns && b.run_queue_ns) counts.run_queue_ns = *b.run_queue_ns - *a.run_queue_ns;
  const std::uint64_t ticks = to.machine.total - from.machine.total;
  if (ticks > 0) {
    counts.stolen = static_cast<double>(to.machine.stolen - from.machine.stolen) / static_cast<double>(ticks);
  }
  return counts;
}

}  // namespace robot_control
