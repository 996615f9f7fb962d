#pragma once
/// The controller's duty in one cycle: state k (which woke it), sensors k and the newest live permit ≤ k-1
/// → command k. A state that is a token or corrupt makes the command a token.

#include <cstdint>
#include <memory>

#include "bus/latest_frames.h"
#include "bus/latest_value.h"
#include "loop/command_script.h"
#include "loop/cycles/close_row.h"
#include "loop/cycles/cycle_clock.h"
#include "loop/cycles/rows.h"
#include "loop/cycles/snapshots.h"
#include "robots/laws.h"
#include "signals/trace.h"

namespace robot_control {

class ControllerCycle {
 public:
  struct Channels {
    const FrameReader<SensorFrame>* sensors;
    const FrameReader<StateFrame>* state;
    const FrameReader<Permit>* permit;
    FrameWriter<CommandFrame> command;
  };

  /// `robot_hash` is that of the machine (process.h).
  ControllerCycle(std::unique_ptr<ControllerLaw> controller, std::uint64_t robot_hash, const Channels& channels,
                  CommandScript script, Now now);

  /// Continues as `other` would, on channels with the same frames.
  ControllerCycle(const ControllerCycle& other, const Channels& channels);

  /// In from the outside: one ordinary thread stores, this cycle loads.
  LatestValue<VelocityCommand>& inbox() noexcept { return inbox_; }

  /// Other limits and gains: one ordinary thread stores; they hold from the next cycle on that computes a command.
  LatestValue<LiveTuning>& tunings() noexcept { return tunings_; }

  /// Random number of this process, in every row.
  void set_process(std::uint64_t process) noexcept { calls_.law.process = process; }

  /// True when there was a new state of the driver's current run, and a command was computed from it and
  /// published.
  bool step() noexcept;

  /// The row of the last step that returned true.
  const ControllerTrace& trace() const noexcept { return rows_.last(); }

  /// The law's state before the step of the last row, where it was copied; else null.
  const LawSnapshot* snapshot() const noexcept { return snapshots_.taken(); }

 private:
  ControllerCycle(const ControllerCycle& other) = default;
  void use(const LiveTuning& tuning) noexcept;
  void take_over(const VelocityCommand& arrived) noexcept;
  void enter_run(std::uint64_t run) noexcept;
  void receive(std::uint64_t cycle) noexcept;
  void tune() noexcept;

  OwnedLaw<ControllerLaw> controller_;
  CycleClock clock_;
  Channels channels_;
  CommandScript script_;
  std::uint64_t robot_hash_;
  LatestValue<VelocityCommand> inbox_;
  LatestValue<LiveTuning> tunings_;
  std::uint64_t tunings_seen_ = 0;  ///< version of the one that was looked at
  std::uint64_t inbox_seen_ = 0;    ///< version of the command that was read last
  VelocityCommand received_;        ///< what the inbox held when last looked at
  VelocityCommand request_;         ///< inbox and script merged in the order of arrival
  SensorFrame sensors_;             ///< buffers of the inputs from other threads
  StateFrame state_;
  Permit permit_;
  ControllerCalls calls_ = first_row<ControllerCalls>();  ///< since the last row
  Snapshots snapshots_;
  Rows<ControllerTrace> rows_;
};

}  // namespace robot_control
