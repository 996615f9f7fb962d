#pragma once
/// TimingSummary collects the figures that a telemetry writes to its log every 10 s and at its end.

#include <array>
#include <cstdint>
#include <optional>

#include "log/messages/log_messages.h"
#include "log/rows/joined_row.h"
#include "rt/thread_counters.h"
#include "signals/robot_kinds.h"
#include "timing/loop_durations.h"

namespace robot_control {

class TimingSummary {
 public:
  static constexpr std::int64_t kPeriodNs = 10'000'000'000;

  /// The figures have the names of these programs.
  explicit TimingSummary(const Programs& programs);

  void add(const JoinedRow& row) noexcept;

  /// Returns whether a summary is due; the next one is due `kPeriodNs` later.
  bool due(std::int64_t now_ns) noexcept;

  /// `threads` are the ids of the real-time threads, by Role; 0: not known. The counts of a thread that has ended are
  /// those of the last call.
  TraceSummary summary(std::int64_t now_ns, const std::array<int, kLoopRoles>& threads);

 private:
  Programs programs_;
  LoopDurations durations_;
  std::array<std::optional<ThreadCounters>, kLoopRoles> counters_;
  std::int64_t due_ns_ = 0;
};

}  // namespace robot_control
