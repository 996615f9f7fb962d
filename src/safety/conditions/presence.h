#pragma once
/// Are the other nodes there, and does the monitor itself keep up?
///
///   estimator lost   k − k_seen ≥ loss_cycles, from the first state of this run on
///   controller lost  the same of commands, while states come: without a state there is no command to miss
///   command stale    in each of the last loss_cycles cycles the command descended from another state than its own
///                    cycle's (CommandFrame::state_cycle ≠ head.cycle), though that state was there: a controller that
///                    publishes old content under a new head, or that is late all the time
///   monitor late     k − k_last > loss_cycles between two steps of one run: others would have been judged too late
///
/// Counts are of cycles, not of looks: a monitor that skips cycles is no slower to see a loss.

#include <cstdint>

#include "safety/latch/active_causes.h"
#include "safety/monitor_input.h"

namespace robot_control {

class Presence {
 public:
  explicit Presence(std::uint64_t loss_cycles) noexcept : loss_cycles_(loss_cycles) {}

  /// Nobody of this run was seen.
  void enter_run() noexcept { *this = Presence(loss_cycles_); }

  /// `elapsed`: cycles since the last step, ≥ 1.
  void step(const MonitorInput& input, std::uint64_t elapsed, ActiveCauses& out) noexcept;

  /// MissingNode bits: not seen in this run.
  std::uint64_t missing() const noexcept { return missing_; }

 private:
  void judge(StopCause cause, std::uint64_t cycles, ActiveCauses& out) const noexcept;

  std::uint64_t loss_cycles_;
  std::uint64_t missing_ = kMissingSensors | kMissingState | kMissingCommand;
  std::uint64_t command_seen_ = 0;  ///< last cycle with a command, or without a state
  std::uint64_t state_seen_ = 0;    ///< last cycle with a state
  std::uint64_t stale_ = 0;         ///< cycles in a row
};

}  // namespace robot_control
