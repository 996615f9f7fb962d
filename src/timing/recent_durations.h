#pragma once
/// RecentDurations holds the durations of one quantity since the start, and those of the last ten seconds.

#include <array>
#include <cstdint>

#include "timing/duration_histogram.h"

namespace robot_control {

class RecentDurations {
 public:
  static constexpr std::int64_t kSeconds = 10;

  /// `time_ns` is when the duration was measured. An older second than the last ten counts for `total` alone.
  void add(std::int64_t duration_ns, std::int64_t time_ns) noexcept;

  DurationFigures total() const noexcept { return figures_of(total_); }

  /// Returns the figures of the running second and the nine before it.
  DurationFigures recent(std::int64_t now_ns) const noexcept;

 private:
  /// 65,535 samples of a second suffice, because no loop is faster than 2 kHz.
  using Second = durations::Counts<std::uint16_t>;

  DurationHistogram total_;
  std::array<Second, kSeconds> seconds_;
  std::array<std::int64_t, kSeconds> numbers_{};  ///< time of each second in s; 0: it is empty
};

}  // namespace robot_control
