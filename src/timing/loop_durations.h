#pragma once
/// LoopDurations computes the durations that tell how punctual the loop is, from the times of its cycles.
///
///   period            from one wake-up to that of the next cycle
///   wake_up           driver: from its deadline to its wake-up; other roles: from the publication of the frame that
///                     wakes them to their wake-up
///   execution         from the wake-up to the publication of the own frame. What a thread does afterwards lies
///   outside:
///                     the gate and a simulator's physics in the driver, the row of the trace
///   sensor_to_command from the driver's wake-up, at which it samples the sensors, to the published command
///   sensor_to_torque  from the wake-up of the driver's cycle from which the command descends to the publication of the
///                     cycle in which the gate passed it; the gate and the motors follow
///
/// A frame that was published after the wake-up has not caused it: such a cycle has no wake-up latency.
///
/// A tick that slips (Periodic) begins a new grid: its lateness counts as wake-up latency. A period over a pause, over
/// a skipped cycle or between runs is no period. A command from before a pause has no sensor_to_torque.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "signals/roles.h"
#include "signals/trace.h"
#include "timing/duration_histogram.h"

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

enum class Quantity : std::uint8_t { kCyclePeriod, kWakeUp, kExecution, kSensorToCommand, kSensorToTorque };

std::string_view name_of(Quantity quantity) noexcept;

/// The role whose frame wakes this one; the driver is woken by the clock.
constexpr Role waker_of(Role role) noexcept {
  return role == Role::kController ? Role::kEstimator : Role::kDriver;
}

class LoopDurations {
 public:
  /// Each of these roles has period, wake_up and execution; the controller also sensor_to_command, and the driver
  /// sensor_to_torque.
  explicit LoopDurations(const std::vector<Role>& roles);

  /// Adds a cycle. Those of a run come in their order. A role that answers a cycle again does not count.
  void add(const CycleTimes& times) noexcept;

  struct Entry {
    Role role;
    Quantity quantity;
    RecentDurations durations;
  };
  const std::vector<Entry>& entries() const noexcept { return entries_; }

  std::uint64_t overruns() const noexcept { return overruns_; }                                         ///< of all runs
  std::uint64_t skipped(Role role) const noexcept { return skipped_[static_cast<std::size_t>(role)]; }  ///< cycles

 private:
  static constexpr std::size_t kRememberedCycles = 16;  ///< cycles; a command lives four

  struct Last {
    std::uint64_t run = 0;
    std::uint64_t cycle = 0;
    std::int64_t woke_ns = 0;
  };

  std::optional<std::int64_t> measure(Role role, Quantity quantity, const CycleTimes& times) const noexcept;

  std::vector<Entry> entries_;
  std::array<Last, kLoopRoles> last_{};
  DriverTimes driver_;                                  ///< of the cycle before
  std::array<DriverTimes, kRememberedCycles> marks_{};  ///< by cycle
  std::uint64_t overruns_ = 0;
  std::array<std::uint64_t, kLoopRoles> skipped_{};
};

}  // namespace robot_control
