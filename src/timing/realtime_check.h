#pragma once
/// RealtimeCheck compares what a real-time thread did with what it may do: wait, and nothing else that blocks or
/// faults. An ordinary thread gives it the counts of the kernel once per second.
///
///   page faults   each is a violation
///   blocks        voluntary switches beyond the waits of the same interval: a lock, a file, I/O that blocks. The
///                 first of an interval is not seen, because a wait may begin before a reading and switch after it; a
///                 wait that did not switch hides another one
///
/// The counts begin when the thread has run for kStartNs; its first cycles touch their memory for the first time.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "rt/thread_counters.h"

namespace robot_control {

/// One reading. The waits are read before and after the counters, so that a wait between the two reads does no harm.
struct RealtimeReading {
  std::int64_t time_ns = 0;
  std::uint64_t waits_before = 0;
  ThreadCounters counters = {};
  std::uint64_t waits_after = 0;
  MachineTime machine = {};
};

/// Counts of an interval.
struct RealtimeCounts {
  std::uint64_t page_faults = 0;
  std::uint64_t blocks = 0;
  std::uint64_t voluntary_switches = 0;
  std::uint64_t forced_switches = 0;
  std::optional<std::uint64_t> run_queue_ns = {};
  double stolen = 0;  ///< share of the processors' time, 0 … 1
};

class RealtimeCheck {
 public:
  static constexpr std::int64_t kStartNs = 2'000'000'000;
  static constexpr std::size_t kReadings = 11;  ///< ten intervals of a second

  void add(const RealtimeReading& reading) noexcept;

  RealtimeCounts total() const noexcept { return between(first_, newest(), blocks_); }
  RealtimeCounts recent() const noexcept;  ///< of the last ten readings

 private:
  struct Kept {
    RealtimeReading reading;
    std::uint64_t blocks = 0;  ///< up to this reading
  };

  const RealtimeReading& newest() const noexcept {
    return count_ == 0 ? first_ : kept_[(count_ - 1) % kReadings].reading;
  }
  static RealtimeCounts between(const RealtimeReading& from, const RealtimeReading& to, std::uint64_t blocks) noexcept;

  std::optional<std::int64_t> began_ns_;
  RealtimeReading first_;
  std::array<Kept, kReadings> kept_;
  std::size_t count_ = 0;
  std::uint64_t blocks_ = 0;
};

}  // namespace robot_control
