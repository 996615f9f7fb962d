#pragma once
/// Conditions that the driver reports about the machine.
///
///   driver fault   driver_state kFault, faults ≠ 0, the fault word of a drive ≠ 0, whose joint is named, or
///                  driver_state kStarting after another state of this run: the machine was switched on again; leads to
///                  FAULT
///   not ready      driver_state kStarting for start_timeout; leads to FAULT
///   overruns       growth of SensorFrame::overruns over the last second, in steps of a tenth; overruns before the
///                  first step do not count. The limit is at most half of the cycles of a second
///   battery        voltage below its limit, if a battery is reported

#include <array>
#include <cstdint>

#include "safety/latch/active_causes.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class MachineConditions {
 public:
  /// `period` s.
  MachineConditions(const SafetyParameters& parameters, double period) noexcept;

  void enter_run() noexcept;
  void step(const SensorFrame& sensors, std::uint64_t elapsed, ActiveCauses& out) noexcept;

  /// In the last step the machine was not ready yet, so that its sensors need not report.
  bool starting() const noexcept { return starting_ > 0; }

 private:
  static constexpr std::size_t kSlots = 10;

  std::uint64_t overruns_of_the_last_second(std::uint64_t overruns, std::uint64_t elapsed) noexcept;

  void evaluate_start(bool starting, std::uint64_t elapsed, ActiveCauses& out) noexcept;

  double period_;
  double start_timeout_;        ///< s
  std::uint64_t starting_ = 0;  ///< cycles without a break
  bool was_ready_ = false;      ///< in this run
  ConditionWatch overruns_;
  ConditionWatch battery_low_;
  ConditionWatch battery_empty_;
  std::uint64_t mark_cycles_;  ///< between two marks
  std::uint64_t since_mark_ = 0;
  bool marked_ = false;
  std::size_t oldest_ = 0;
  std::array<std::uint64_t, kSlots> marks_{};  ///< the counter, a tenth of a second apart
};

}  // namespace robot_control
