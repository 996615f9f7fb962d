#pragma once
/// The monitor's duty in one cycle: sensors k (which woke it), command k-1, state k-1 → permit k.
///
/// Every step of the law has one row of the trace. A step without a new sensor frame repeats the run, cycle and stamp
/// of the last one in its permit. Before the first frame it has no row: the snapshot in the first row covers it.
///
/// A sensor frame is current if it is whole and of the run and robot that the channel's head announces. Wall clock: a
/// wake-up without one counts as silence once the last one is loss_cycles periods old.

#include <atomic>
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

class MonitorCycle {
 public:
  struct Channels {
    const FrameReader<SensorFrame>* sensors;
    const FrameReader<StateFrame>* state;
    const FrameReader<CommandFrame>* command;
    FrameWriter<Permit> permit;
  };

  /// Inherits the latch of the permit in the channel and of `latch`, another record of an earlier stop. `robot_hash` is
  /// that of the machine (process.h), `loss_ns` the length of loss_cycles periods.
  MonitorCycle(std::unique_ptr<MonitorLaw> monitor, std::uint64_t robot_hash, std::int64_t loss_ns,
               const Channels& channels, CommandScript script, Now now, InheritedLatch latch = {});

  /// Continues as `other` would, on channels with the same frames.
  MonitorCycle(const MonitorCycle& other, const Channels& channels);

  /// In from the outside: one ordinary thread stores, this cycle loads.
  LatestValue<OperatorInput>& inbox() noexcept { return inbox_; }

  /// Random number of this process, in every row.
  void set_process(std::uint64_t process) noexcept { calls_.law.process = process; }

  /// Something woke the monitor. True: a permit was published, and `trace` is its row.
  bool step() noexcept;

  /// Wall clock: nothing woke the monitor for loss_cycles periods. Unless the driver's last frame reported that it is
  /// paused or has ended, that latches kCauseDriverLost. True: as in `step`.
  bool time_out() noexcept { return step_without_frame(true); }

  /// Nothing woke the monitor for a while. Resets are refused and emergency stops latch. Before the first frame the
  /// permit is one of kRunBeforeDriver, which no gate uses. True: as in `step`.
  bool idle() noexcept { return step_without_frame(false); }

  /// The permit of the last step; before `step` and `idle`, that of the start, with the inherited latch.
  const Permit& permit() const noexcept { return rows_.last().permit; }

  /// Any thread: run of the permits that this process publishes; 0: none yet.
  std::uint64_t published_run() const noexcept { return published_run_.load(std::memory_order_acquire); }

  /// Permits without a driver; a driver mints random numbers.
  static constexpr std::uint64_t kRunBeforeDriver = 1;

  /// The row of the last step that returned true.
  const MonitorTrace& trace() const noexcept { return rows_.last(); }

  /// The law's state before the step of the last row, where it was copied; else null.
  const LawSnapshot* snapshot() const noexcept { return snapshots_.taken(); }

 private:
  /// This cycle writes it, any thread reads it.
  struct SharedRun : std::atomic<std::uint64_t> {
    using std::atomic<std::uint64_t>::atomic;
    SharedRun(const SharedRun& other) noexcept : std::atomic<std::uint64_t>(other.load()) {}
  };

  MonitorCycle(const MonitorCycle& other) = default;
  void inherit(InheritedLatch latch) noexcept;
  void receive_messages() noexcept;
  void advance_script() noexcept;
  void read_inputs(const SensorFrame& sensors) noexcept;
  bool step_without_frame(bool timed_out) noexcept;
  bool republished(const SensorFrame& arrived) noexcept;
  SensorSilence silence(bool timed_out) const noexcept;
  bool happened(const MonitorInput& input) const noexcept;
  void step_law(std::int64_t woke_ns) noexcept;
  void publish(std::uint64_t run, Permit& permit) noexcept;

  OwnedLaw<MonitorLaw> monitor_;
  CycleClock clock_;
  Channels channels_;
  CommandScript script_;
  std::uint64_t robot_hash_;
  std::int64_t loss_ns_;         ///< loss_cycles periods
  std::int64_t current_ns_ = 0;  ///< wall clock of the last wake-up that found a current frame
  SharedRun published_run_{0};
  LatestValue<OperatorInput> inbox_;
  std::uint64_t inbox_seen_ = 0;       ///< version of the input that was read last
  OperatorInput received_;             ///< content of the inbox when it was last read
  OperatorInput operator_input_;       ///< sum of inbox and script
  std::uint64_t corrupt_sensors_ = 0;  ///< attempts in a row that read a corrupt frame
  FrameHead head_;                     ///< of the sensors in the last step with a frame
  std::int64_t due_ns_ = 0;            ///< of that cycle
  DriverState driver_state_ = DriverState::kStarting;
  SensorFrame buffer_;  ///< buffers of the inputs from other threads
  StateFrame state_;
  CommandFrame command_;
  MonitorInput input_;                              ///< of the last step
  MonitorCalls calls_ = first_row<MonitorCalls>();  ///< of the next row
  Snapshots snapshots_;
  Rows<MonitorTrace> rows_;
};

}  // namespace robot_control
