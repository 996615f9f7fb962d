#pragma once
/// One row of the log holds what all four nodes did in one cycle.

#include <cstdint>

#include "signals/trace.h"

namespace robot_control {

/// Row k joins sensors k, state k, command k and permit k. The gate's report is that of tick k, which used command and
/// permit k-1. A null pointer means that the node has no frame for this cycle: it was lost, or a token passed.
struct JoinedRow {
  std::int64_t run = 0;     ///< 0, 1, … in the order in which the runs began
  std::uint64_t cycle = 0;  ///< k
  double time = 0;          ///< s since the run began: k · period
  const DriverTrace* driver = nullptr;
  const EstimatorTrace* estimator = nullptr;
  const ControllerTrace* controller = nullptr;
  const MonitorTrace* monitor = nullptr;

  /// The same rows, also if an injected fault suppressed the frame: the law ran, and a token was published.
  struct Laws {
    const EstimatorTrace* estimator = nullptr;
    const ControllerTrace* controller = nullptr;
    const MonitorTrace* monitor = nullptr;
  };
  Laws laws{};

  /// True: a node answered a cycle again. It was restarted, or it is the monitor without a new sensor frame. Its row
  /// alone is in `laws`, and this is no row of the run.
  bool repeats = false;

  /// Sets `laws` and, unless the row `repeats`, the pointers to those whose frame was published.
  void set(const Laws& ran) noexcept {
    laws = ran;
    if (repeats) return;
    if (laws.estimator != nullptr && published(laws.estimator->state.head)) estimator = laws.estimator;
    if (laws.controller != nullptr && published(laws.controller->command.head)) controller = laws.controller;
    if (laws.monitor != nullptr && published(laws.monitor->permit.head)) monitor = laws.monitor;
  }

  /// Puts the row of one node in, beside those that are there; its frame was not published.
  void put(const DriverTrace& row) noexcept { driver = &row; }
  void put(const EstimatorTrace& row) noexcept { laws.estimator = &row; }
  void put(const ControllerTrace& row) noexcept { laws.controller = &row; }
  void put(const MonitorTrace& row) noexcept { laws.monitor = &row; }

 private:
  static bool published(const FrameHead& head) noexcept { return head.kind == FrameKind::kFrame; }
};

/// `time` is always computed here, so that equal cycles have equal bits.
inline double row_time(std::uint64_t cycle, double period) noexcept {
  return static_cast<double>(cycle) * period;
}

}  // namespace robot_control
