#pragma once
/// The times of one cycle on the clock of the stamps, as the rows of the trace have them.

#include <array>
#include <cstdint>
#include <optional>

#include "signals/trace.h"

namespace robot_control {

inline constexpr std::size_t kLoopRoles = 4;  ///< driver, estimator, controller, monitor; the order of Role

/// The driver's times of a cycle.
struct DriverTimes {
  std::uint64_t run = 0;
  std::uint64_t cycle = 0;
  std::int64_t due_ns = 0;      ///< `due_ns` of its sensors
  std::int64_t slipped_ns = 0;  ///< SensorFrame::slipped_ns
  std::int64_t held_ns = 0;     ///< SensorFrame::held_ns
  std::uint64_t overruns = 0;   ///< SensorFrame::overruns
  CycleTiming timing = {};
  std::optional<std::uint64_t> command_cycle = {};  ///< cycle of the command that the gate used; empty: it braked
};

inline DriverTimes times_of(const DriverTrace& row) noexcept {
  DriverTimes times{.run = row.sensors.head.run,
                    .cycle = row.sensors.head.cycle,
                    .due_ns = due_ns(row.sensors),
                    .slipped_ns = static_cast<std::int64_t>(row.sensors.slipped_ns),
                    .held_ns = static_cast<std::int64_t>(row.sensors.held_ns),
                    .overruns = row.sensors.overruns,
                    .timing = row.timing};
  if (row.gate.verdict != GateVerdict::kBrake) times.command_cycle = row.gate.command_cycle;
  return times;
}

/// The timing of each role, by Role; one that has no row of this cycle is empty. The driver's is always there.
struct CycleTimes {
  DriverTimes driver;
  std::array<std::optional<CycleTiming>, kLoopRoles> timing;
};

}  // namespace robot_control
