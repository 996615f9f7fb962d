#pragma once
/// Periodic computes the absolute deadlines of a loop on the wall clock. It never reads a clock: time is an argument.
///
///   for (std::int64_t k = 0;; ++k) {
///     sleep_until(schedule.deadline_ns());
///     k += schedule.begin(monotonic_ns());
///     … tick k …
///     schedule.end(monotonic_ns());
///   }
///
///   deadline(k) = start + k·period + slipped
///
/// A sleep relative to the wake-up would add every latency to the period; this grid does not. A wake-up that is late by
/// less than one period keeps the grid. After a longer delay the missed ticks are not made up by a burst of ticks:
///   kSlip  a simulated plant: time slips. The tick runs now, k stays consecutive, the grid moves by the
///          lateness, which is counted: slipped = now − deadline.
///   kSkip  hardware: time has passed. The grid stays, k jumps over the missed periods:
///          missed = ⌊(now − deadline) / period⌋.
///
///               begin: late < period
///   waiting ─────────────────────────────▶ running k ─── end: deadline += period ──▶ waiting
///      │                                       ▲               (late: overruns += 1, and the next begin is at once)
///      │  begin: late ≥ period, kSkip          │
///      ├──── k += missed, grid stays ──────────┤
///      │  begin: late ≥ period, kSlip          │
///      └──── grid += late, k consecutive ──────┘

#include <cstdint>

namespace robot_control {

enum class WhenLate { kSlip, kSkip };

class Periodic {
 public:
  /// `start_ns` is the deadline of the first tick.
  Periodic(std::int64_t start_ns, std::int64_t period_ns, WhenLate when_late = WhenLate::kSlip) noexcept
      : deadline_ns_(start_ns), period_ns_(period_ns), when_late_(when_late) {}

  /// Returns the deadline of the next tick; between `begin` and `end`, that of the running tick.
  std::int64_t deadline_ns() const noexcept { return deadline_ns_; }

  /// Begins a tick at `now_ns`. Returns how many periods were missed before it; with kSlip always 0.
  std::int64_t begin(std::int64_t now_ns) noexcept {
    const std::int64_t late_ns = now_ns > deadline_ns_ ? now_ns - deadline_ns_ : 0;
    if (late_ns < period_ns_) return 0;
    if (when_late_ == WhenLate::kSlip) {
      slipped_ns_ += late_ns;
      deadline_ns_ = now_ns;
      return 0;
    }
    const std::int64_t periods = late_ns / period_ns_;
    missed_ += periods;
    deadline_ns_ += periods * period_ns_;
    return periods;
  }

  /// Ends the tick at `now_ns` and advances the deadline. Returns false if that has passed already (overrun).
  bool end(std::int64_t now_ns) noexcept {
    deadline_ns_ += period_ns_;
    if (now_ns <= deadline_ns_) return true;
    ++overruns_;
    return false;
  }

  std::int64_t slipped_ns() const noexcept { return slipped_ns_; }  ///< total
  std::int64_t missed() const noexcept { return missed_; }          ///< periods, total
  std::uint64_t overruns() const noexcept { return overruns_; }

 private:
  std::int64_t deadline_ns_;
  std::int64_t period_ns_;
  WhenLate when_late_;
  std::int64_t slipped_ns_ = 0;
  std::int64_t missed_ = 0;
  std::uint64_t overruns_ = 0;
};

}  // namespace robot_control
