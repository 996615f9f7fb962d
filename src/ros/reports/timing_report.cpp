#include "ros/reports/timing_report.h"

#include "signals/formatted_text.h"

namespace robot_control {
namespace {

constexpr std::int64_t kReadingPeriod = 1'000'000'000;  // ns

}  // namespace

std::string in_words(const DurationFigures& figures) {
  const auto us = [](std::int64_t duration_ns) { return static_cast<double>(duration_ns) * 1e-3; };
  return formatted("min %.1f p50 %.1f p99 %.1f p99.9 %.1f max %.1f n %llu", us(figures.min), us(figures.p50),
                   us(figures.p99), us(figures.p999), us(figures.max),
                   static_cast<unsigned long long>(figures.samples));
}

std::string violations_in_words(const RealtimeCounts& counts, bool memory_locked) {
  std::string text;
  if (memory_locked && counts.page_faults != 0) text = std::to_string(counts.page_faults) + " page faults";
  if (counts.blocks == 0) return text;
  if (!text.empty()) text += ", ";
  return text + std::to_string(counts.blocks) + " waits outside of its loop";
}

TimingReport::TimingReport(const LoopParameters& loop, const std::string& bus, Role role)
    : role_(role), counts_(loop.realtime_checks == RealtimeChecks::kCount), timing_(bus, role) {}

void TimingReport::poll(const RealtimeThread* thread, std::int64_t now_ns) {
  timing_.poll();
  if (!counts_ || thread == nullptr || now_ns < next_reading_ns_) return;
  next_reading_ns_ = now_ns + kReadingPeriod;
  memory_locked_ = thread->report().memory_lock == Grant::kGranted;
  RealtimeReading reading{.time_ns = now_ns, .waits_before = thread->waits()};
  const auto counters = read_thread_counters(thread->id());
  if (!counters) return;  // the thread has ended
  reading.counters = *counters;
  reading.waits_after = thread->waits();
  reading.machine = read_machine_time();
  check_.add(reading);
}

void TimingReport::report(DiagnosticReport& report, std::int64_t now_ns) const {
  for (const auto& [role, quantity, durations] : timing_.durations().entries()) {
    const std::string name(name_of(quantity));
    report.value(name + "_us", in_words(durations.total()));
    report.value(name + "_10s_us", in_words(durations.recent(now_ns)));
  }
  report.value("skipped_cycles", timing_.durations().skipped(role_));
  if (counts_) report_check(report);
}

void TimingReport::report_check(DiagnosticReport& report) const {
  const RealtimeCounts recent = check_.recent();
  const RealtimeCounts total = check_.total();
  if (const std::string text = violations_in_words(recent, memory_locked_); !text.empty()) {
    report.warn("not real-time in the last 10 s: " + text + " (docs/timing.md)");
  }
  report.value("page_faults", total.page_faults);
  report.value("waits_outside_loop", total.blocks);
  report.value("voluntary_switches", total.voluntary_switches);
  report.value("forced_switches", total.forced_switches);
  if (recent.run_queue_ns) {
    report.value("run_queue_10s_us", *recent.run_queue_ns / 1000);
  } else {
    report.value("run_queue_10s_us", "this kernel does not count it (CONFIG_SCHED_INFO)");
  }
  report.value("stolen_10s_percent", 100 * recent.stolen);
}

}  // namespace robot_control
