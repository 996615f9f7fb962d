#pragma once
/// One row of the log: what all four nodes did in one cycle.

#include <cstdint>

#include "signals/trace.h"

namespace robot_control {

/// Row k joins sensors k, state k, command k and permit k; the gate's report is that of tick k, which used
/// command and permit k-1. Null: that node has no frame for this cycle (lost, or a token passed).
struct JoinedRow {
  std::int64_t run = 0;     ///< 0, 1, … in the order in which the runs began
  std::uint64_t cycle = 0;  ///< k
  double time = 0;          ///< s since the run began: k · period
  const DriverTrace* driver = nullptr;
  const EstimatorTrace* estimator = nullptr;
  const ControllerTrace* controller = nullptr;
  const MonitorTrace* monitor = nullptr;

  /// The same rows, also where an injected fault suppressed the frame: the law ran, and a token was published.
  struct Laws {
    const EstimatorTrace* estimator = nullptr;
    const ControllerTrace* controller = nullptr;
    const MonitorTrace* monitor = nullptr;
  };
  Laws laws{};

  /// A node answered a cycle again: one that was started again, or the monitor, without a new sensor frame. The row
  /// holds that node alone, in `laws`, and is no row of the run.
  bool repeats = false;

  /// Fills in the rows of the laws, and of them those whose frame was published; where it `repeats`, the former alone.
  void set(const Laws& ran) noexcept {
    laws = ran;
    if (repeats) return;
    if (laws.estimator != nullptr && published(laws.estimator->state.head)) estimator = laws.estimator;
    if (laws.controller != nullptr && published(laws.controller->command.head)) controller = laws.controller;
    if (laws.monitor != nullptr && published(laws.monitor->permit.head)) monitor = laws.monitor;
  }

 private:
  static bool published(const FrameHead& head) noexcept { return head.kind == FrameKind::kFrame; }
};

/// The one way to compute `time`, so that equal cycles have equal bits wherever a row is made.
inline double row_time(std::uint64_t cycle, double period) noexcept {
  return static_cast<double>(cycle) * period;
}

}  // namespace robot_control
