#pragma once
/// A TimingReport adds to a node's entry on /diagnostics how punctual its real-time thread is, and what that thread
/// does beside its work. It reads the trace and /proc in an ordinary thread; the real-time thread does not notice it.

#include <cstdint>
#include <string>

#include "configuration/loop_parameters.h"
#include "ros/reports/diagnostics.h"
#include "rt/realtime_thread.h"
#include "signals/roles.h"
#include "timing/realtime_check.h"
#include "timing/trace_timing.h"

namespace robot_control {

class TimingReport {
 public:
  TimingReport(const LoopParameters& loop, const std::string& bus, Role role);

  /// At 10 Hz. `thread` is null before it started.
  void poll(const RealtimeThread* thread, std::int64_t now_ns);

  void report(DiagnosticReport& report, std::int64_t now_ns) const;

 private:
  void report_check(DiagnosticReport& report) const;

  Role role_;
  bool counts_;  ///< robot.realtime_checks
  TraceTiming timing_;
  RealtimeCheck check_;
  bool memory_locked_ = false;
  std::int64_t next_reading_ns_ = 0;
};

/// Returns "min 2.1 p50 8.4 p99 31.0 p99.9 55.2 max 120.3 n 10000", in µs.
std::string in_words(const DurationFigures& figures);

/// Returns "3 page faults, 2 waits outside of its loop"; "" if there is no violation.
std::string violations_in_words(const RealtimeCounts& counts, bool memory_locked);

}  // namespace robot_control
