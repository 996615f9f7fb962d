#pragma once
/// The monitor's duty in one cycle: sensors k (which woke it), command k-1, head of state k-1 → permit k.
///
/// Wall clock: a step that finds no current sensor frame (none, corrupt, of another run or robot than the channel's
/// head announces) counts as silence once the last current frame is loss_cycles periods old, whatever woke the step.

#include <atomic>
#include <cstdint>

#include "robot/robot_model.h"
#include "rt/latest_frames.h"
#include "rt/latest_value.h"
#include "runtime/command_script.h"
#include "runtime/cycles/close_row.h"
#include "runtime/cycles/cycle_clock.h"
#include "runtime/cycles/snapshots.h"
#include "safety/safety_monitor.h"
#include "signals/trace.h"

namespace robot_control {

class MonitorCycle {
 public:
  struct Channels {
    const FrameReader<SensorFrame>* sensors;
    const FrameReader<StateFrame>* state;
    const FrameReader<CommandFrame>* command;
    FrameWriter<Permit> permit;
  };

  MonitorCycle(const SafetyParameters& parameters, const RobotModel& robot, double period, const Channels& channels,
               CommandScript script, Now now);

  /// In from the outside: one ordinary thread stores, this cycle loads.
  LatestValue<OperatorInput>& inbox() noexcept { return inbox_; }

  /// Random number of this process, in every row.
  void set_process(std::uint64_t process) noexcept { calls_.law.process = process; }

  /// True when there was a new sensor frame of the driver's current run, and a permit was computed from it and
  /// published.
  bool step() noexcept;

  /// Wall clock: no current sensor frame has come for loss_cycles periods. Unless the driver's last frame reported that
  /// it is paused or has ended, that latches kCauseDriverLost, and the last permit is published again with it. Then as
  /// `idle`.
  void silence() noexcept;

  /// No frame has come for a while: answers resets, with a refusal, and emergency stops, with the latch. Before the
  /// first frame the permit goes out as one of kRunBeforeDriver, which no gate uses.
  void idle() noexcept;

  /// What an earlier monitor had latched beyond what the channel still holds; before the first step.
  void restore(std::uint64_t causes, std::uint64_t first_cause) noexcept { monitor_.restore(causes, first_cause); }

  /// Before the first step: the topic `e_stop` was true when an earlier monitor ended, or may have been.
  bool e_stop_held() const noexcept { return monitor_.e_stop_held(); }

  /// What was latched when this monitor started.
  std::uint64_t causes() const noexcept { return monitor_.causes(); }

  /// Any thread: run of the permits that this process publishes; 0: none yet.
  std::uint64_t published_run() const noexcept { return published_run_.load(std::memory_order_acquire); }

  /// Permits without a driver; a driver mints random numbers.
  static constexpr std::uint64_t kRunBeforeDriver = 1;

  /// The row of the last step that returned true.
  const MonitorTrace& trace() const noexcept { return trace_; }

  /// The law's state before the step of the last row, where it was copied; else null.
  const LawSnapshot* snapshot() const noexcept { return snapshots_.taken(); }

 private:
  void enter_run() noexcept;
  void receive_messages() noexcept;
  void note_corrupt_sensors() noexcept;
  void note_pause() noexcept;
  void receive(std::uint64_t cycle) noexcept;
  void publish_again() noexcept;
  void restore_last_permit() noexcept;
  bool wake_without_sensors(std::int64_t woke_ns) noexcept;
  void idle_without_driver() noexcept;
  void note(MonitorCall call, const OperatorInput& operator_input = {}, std::uint64_t argument = 0) noexcept;
  void note_output(std::uint64_t output) noexcept;
  void close_row() noexcept;
  bool note_emergency_stop() noexcept;
  void refuse_reset(ResetRefusal why) noexcept;
  void publish() noexcept;

  SafetyMonitor monitor_;
  CycleClock clock_;
  Channels channels_;
  CommandScript script_;
  std::uint64_t robot_hash_;
  std::int64_t loss_ns_;         ///< loss_cycles periods
  std::int64_t current_ns_ = 0;  ///< wall clock, when the last current frame was looked at
  bool looked_ = false;          ///< the first step is over
  std::atomic<std::uint64_t> published_run_{0};
  LatestValue<OperatorInput> inbox_;
  OperatorInput received_;        ///< what the inbox held when last looked at
  OperatorInput operator_input_;  ///< inbox and script added up
  OperatorInput noted_;           ///< of the last row or note
  bool silent_ = false;
  std::uint64_t corrupt_sensors_ = 0;  ///< in a row
  SensorFrame arrived_;                ///< as read, not yet checked
  SensorFrame sensors_;                ///< of the last step
  StateFrame state_;
  CommandFrame command_;
  MonitorInput input_;
  MonitorCalls calls_ = first_row<MonitorCalls>();  ///< since the last row
  Snapshots snapshots_;
  MonitorTrace trace_;
};

}  // namespace robot_control
