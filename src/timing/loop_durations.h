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
#include "timing/cycle_times.h"
#include "timing/recent_durations.h"

namespace robot_control {

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
  static constexpr std::size_t kMarks = 16;  ///< cycles; a command lives four

  struct Last {
    std::uint64_t run = 0;
    std::uint64_t cycle = 0;
    std::int64_t woke_ns = 0;
  };

  std::optional<std::int64_t> measure(Role role, Quantity quantity, const CycleTimes& times) const noexcept;

  std::vector<Entry> entries_;
  std::array<Last, kLoopRoles> last_{};
  DriverTimes driver_;                       ///< of the cycle before
  std::array<DriverTimes, kMarks> marks_{};  ///< by cycle
  std::uint64_t overruns_ = 0;
  std::array<std::uint64_t, kLoopRoles> skipped_{};
};

}  // namespace robot_control
