#pragma once
/// A process beside the loop that measures its own gaps. It shares the loop's core, and if that is granted it has a
/// priority above all of the loop. No thread of the loop can then delay it, so a delay is one of the machine.

#include <sched.h>
#include <sys/prctl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>

#include "loop/processes/process.h"
#include "rt/clock.h"
#include "support/processes/anonymous_memory.h"
#include "support/processes/child_process.h"

namespace robot_control {

class StallWitness {
 public:
  static constexpr std::int64_t kPeriodNs = 2'000'000;

  /// `core`: of the loop; -1: any.
  explicit StallWitness(std::int64_t core) : process_([this, core] { return watch(core); }) {}

  /// ns between two of its wake-ups, the longest gap that ended since `since_ns`; the running one counts, too.
  std::int64_t longest_gap_ns(std::int64_t since_ns) const noexcept {
    const std::uint64_t count = seen_->count.load();
    std::int64_t longest = count == 0 ? 0 : monotonic_ns() - seen_->woke_ns.load();
    for (std::uint64_t i = count - std::min<std::uint64_t>(count, kKept); i < count; ++i) {
      const Gap& gap = seen_->gaps[i % kKept];
      if (gap.end_ns.load() >= since_ns) longest = std::max(longest, gap.length_ns.load());
    }
    return longest;
  }

  /// For tests of itself.
  const ChildProcess& process() const noexcept { return process_; }

 private:
  static constexpr std::size_t kKept = 16'384;  // half a minute of periods

  struct Gap {
    std::atomic<std::int64_t> end_ns, length_ns;
  };
  struct Seen {
    std::atomic<std::uint64_t> count;
    std::atomic<std::int64_t> woke_ns;
    std::array<Gap, kKept> gaps;
  };

  [[noreturn]] int watch(std::int64_t core) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (core >= 0) {
      cpu_set_t cores;
      CPU_ZERO(&cores);
      CPU_SET(static_cast<std::size_t>(core), &cores);
      sched_setaffinity(0, sizeof cores, &cores);
    }
    const sched_param above{.sched_priority = static_cast<int>(LoopPriority::kDriver) + 2};
    sched_setscheduler(0, SCHED_FIFO, &above);
    for (std::int64_t last_ns = monotonic_ns();;) {
      sleep_until(last_ns + kPeriodNs);
      const std::int64_t now_ns = monotonic_ns();
      Gap& gap = seen_->gaps[seen_->count.load() % kKept];
      gap.length_ns.store(now_ns - last_ns);
      gap.end_ns.store(now_ns);
      seen_->woke_ns.store(now_ns);
      ++seen_->count;
      last_ns = now_ns;
    }
  }

  AnonymousMemory<Seen> seen_;
  ChildProcess process_;
};

}  // namespace robot_control
