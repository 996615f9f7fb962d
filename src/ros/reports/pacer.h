#pragma once
/// A Pacer decides when a topic is due, by the stamps of the frames instead of a clock. So a rate refers to simulated
/// time in lockstep and to real time otherwise.

#include <cstdint>

namespace robot_control {

class Pacer {
 public:
  /// `rate` is in Hz and > 0.
  explicit Pacer(double rate) noexcept : period_ns_(static_cast<std::int64_t>(1.0e9 / rate + 0.5)) {}

  /// Returns true at most once per period, on average exactly at `rate` if frames arrive at least that often. Missed
  /// messages are not sent later. A new run, or a stamp that went back by more than two periods, restarts the Pacer.
  bool due(std::uint64_t run, std::int64_t stamp_ns) noexcept {
    if (run != run_ || stamp_ns < next_ns_ - 2 * period_ns_) {
      run_ = run;
      next_ns_ = stamp_ns;
    }
    if (stamp_ns < next_ns_) return false;
    next_ns_ += period_ns_;
    if (next_ns_ <= stamp_ns) next_ns_ = stamp_ns + period_ns_;
    return true;
  }

  std::int64_t period_ns() const noexcept { return period_ns_; }

  /// Returns the time from a frame with this stamp to the next one that is due.
  std::int64_t until_due_ns(std::int64_t stamp_ns) const noexcept { return next_ns_ - stamp_ns; }

 private:
  std::int64_t period_ns_;
  std::uint64_t run_ = 0;
  std::int64_t next_ns_ = 0;
};

}  // namespace robot_control
