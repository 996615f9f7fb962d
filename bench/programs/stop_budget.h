#pragma once
/// The stop budget in virtual time: the time from the fact to the brake, and the way of the robot until then.
///
///   fact      the cycle in which it becomes true
///   latched   the monitor's cycle in which the first cause latches: fact + what shows it + persistence
///   stopped   the gate's first tick with a brake, or a ramp, that holds until the robot stands
///   way       length of the true path from the fact to standstill, m
///
/// The sender goes on in ignorance. The result is deterministic: it is the same on every machine.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "bench/programs/stop_scenarios.h"

namespace robot_control::bench {

struct StopMeasurement {
  std::string cause;  ///< the cause that latched first; empty if none did
  std::string fact;
  double speed = 0;  ///< m/s, true speed before the fact
  std::uint64_t fact_cycle = 0;
  std::optional<std::uint64_t> latched_cycle;
  std::optional<std::uint64_t> stopped_cycle;
  bool ramps = false;                           ///< stop category 1
  std::optional<std::uint64_t> standing_cycle;  ///< by truth
  double distance = 0;                          ///< m
  double period = 0;                            ///< s

  /// Cycles from the latch to the gate's tick; nothing if either is missing.
  std::optional<std::uint64_t> reaction() const;
};

/// `path`: the parameter file.
StopMeasurement measure_stop(const std::string& path, const StopScenario& scenario);

/// Three rows for each: ms from fact to brake or ramp, cycles from latch to gate, m of way.
std::vector<Row> stop_rows(const std::vector<StopMeasurement>& measured);

}  // namespace robot_control::bench
