#pragma once
/// These conditions find nodes that make no progress, the monitor among them.
///
///   estimator lost   k − k_last ≥ loss_cycles, from the first state of this run on
///   controller lost  the same for commands, counted only while states arrive: without a state no command is due
///   command stale    in each of the last loss_cycles cycles the command was computed from a state of another cycle
///                    than its own (CommandFrame::state_cycle ≠ head.cycle), although that state existed: a controller
///                    that publishes old content under a new head, or that is always late
///   gate missing     the gate reports that it finds no permit, or it has found no command of this run although the
///                    monitor has. The driver looks for new channels only ten times a second. A monitor that is READY
///                    before would see the gate refuse. In tick 0 the gate looks at neither, and nothing is missing
///   monitor late     k − k_last > loss_cycles between two steps of one run: the other losses would have been detected
///                    too late. So is a loss called of whose cycles half or more were skipped: in a late loop no node
///                    has what another one did not give it
///
/// All counts are cycles of the driver, not steps of the monitor: skipped cycles do not delay the detection of a loss.

#include <cstdint>

#include "safety/latch/active_causes.h"
#include "safety/monitor_input.h"

namespace robot_control {

class Presence {
 public:
  explicit Presence(std::uint64_t loss_cycles) noexcept : loss_cycles_(loss_cycles) {}

  /// A new run: nothing was received yet.
  void enter_run() noexcept { *this = Presence(loss_cycles_); }

  /// `elapsed`: cycles since the last step, ≥ 1.
  void step(const MonitorInput& input, std::uint64_t elapsed, ActiveCauses& out) noexcept;

  /// MissingNode bits: what the monitor has not seen in this run, and what the gate has not.
  std::uint64_t missing() const noexcept { return missing_; }

 private:
  bool gate_finds_both(const MonitorInput& input) const noexcept;
  void add_if_lost(StopCause cause, std::uint64_t cycles, ActiveCauses& out) const noexcept;  ///< or late

  std::uint64_t loss_cycles_;
  std::uint64_t missing_ = kMissingSensors | kMissingState | kMissingCommand;
  bool complete_ = false;           ///< nothing was missing once
  std::uint64_t command_seen_ = 0;  ///< last cycle with a command, or without a state
  std::uint64_t state_seen_ = 0;    ///< last cycle with a state
  std::uint64_t stale_ = 0;         ///< cycles in a row
  std::uint64_t skipped_ = 0;       ///< cycles without a step since the last one with state and command
};

}  // namespace robot_control
