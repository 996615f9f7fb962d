#include "loop/processes/timing_summary.h"

#include <string>

namespace robot_control {
namespace {

void append(TraceSummary& to, const std::string& name, const DurationFigures& figures) {
  to.names.push_back(name);
  to.samples.push_back(figures.samples);
  to.min.push_back(figures.min);
  to.p50.push_back(figures.p50);
  to.p99.push_back(figures.p99);
  to.p999.push_back(figures.p999);
  to.max.push_back(figures.max);
}

}  // namespace

TimingSummary::TimingSummary(const Programs& programs)
    : programs_(programs), durations_({Role::kDriver, Role::kEstimator, Role::kController, Role::kMonitor}) {}

void TimingSummary::add(const JoinedRow& row) noexcept {
  if (row.repeats || row.driver == nullptr) return;
  CycleTimes times{.driver = times_of(*row.driver), .timing = {row.driver->timing}};
  if (row.laws.estimator != nullptr) times.timing[1] = row.laws.estimator->timing;
  if (row.laws.controller != nullptr) times.timing[2] = row.laws.controller->timing;
  if (row.laws.monitor != nullptr) times.timing[3] = row.laws.monitor->timing;
  durations_.add(times);
}

bool TimingSummary::due(std::int64_t now_ns) noexcept {
  if (due_ns_ == 0) due_ns_ = now_ns + kPeriodNs;
  if (now_ns < due_ns_) return false;
  due_ns_ += kPeriodNs;
  return true;
}

TraceSummary TimingSummary::summary(std::int64_t now_ns, const std::array<int, kLoopRoles>& threads) {
  TraceSummary summary{.stamp_ns = now_ns};
  for (const auto& [role, quantity, durations] : durations_.entries()) {
    const std::string name = std::string(program_of(role, programs_)) + "." + std::string(name_of(quantity));
    append(summary, name, durations.total());
    append(summary, name + ".10s", durations.recent(now_ns));
  }
  const auto count = [&](const std::string& name, std::uint64_t number) {
    summary.counters.push_back(name);
    summary.counts.push_back(number);
  };
  const MachineTime machine = read_machine_time();
  count("machine.ticks", machine.total);
  count("machine.stolen_ticks", machine.stolen);
  count(std::string(programs_.driver) + ".overruns", durations_.overruns());
  for (std::size_t i = 0; i < kLoopRoles; ++i) {
    const Role role = static_cast<Role>(i);
    const std::string program(program_of(role, programs_));
    count(program + ".skipped", durations_.skipped(role));
    if (const auto read = threads[i] == 0 ? std::nullopt : read_thread_counters(threads[i])) counters_[i] = read;
    const std::optional<ThreadCounters>& counters = counters_[i];
    if (!counters) continue;
    count(program + ".page_faults", counters->page_faults);
    count(program + ".voluntary_switches", counters->voluntary_switches);
    count(program + ".forced_switches", counters->forced_switches);
    if (counters->run_queue_ns) count(program + ".run_queue_ns", *counters->run_queue_ns);
  }
  return summary;
}

}  // namespace robot_control
