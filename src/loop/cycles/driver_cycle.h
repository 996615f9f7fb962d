#pragma once
/// The driver's duty in one tick k:
///   latch command k-1 and permit k-1 → sample sensors of x(t_k) → publish sensors k → gate
///   → apply torque over [t_k, t_k+1).
/// Latched are the newest command of cycles k-4 … k-1 and the newest permit of cycles k-7 … k-1. The longer range lets
/// the gate distinguish an expired permit from a missing one.
/// A reset that the monitor answered, accepted or refused, is handed to the driver.
/// Sensor-to-torque delay is exactly one period. No clock is read here; `now` stamps the trace only.

#include <cstdint>
#include <optional>

#include "bus/latest_frames.h"
#include "drivers/driver.h"
#include "gate/gate.h"
#include "loop/cycles/close_row.h"
#include "loop/cycles/cycle_clock.h"
#include "loop/cycles/rows.h"
#include "loop/cycles/snapshots.h"
#include "machine/machine_model.h"
#include "signals/trace.h"

namespace robot_control {

class DriverCycle {
 public:
  struct Channels {
    FrameWriter<SensorFrame> sensors;
    FrameWriter<TruthFrame> truth;  ///< without memory: no other process reads it
    const FrameReader<CommandFrame>* command;
    const FrameReader<Permit>* permit;
  };

  /// Throws DriverError as require_stop_actions does.
  DriverCycle(Driver& driver, const MachineModel& robot, const Channels& channels, std::int64_t period_ns, Now now,
              const GateParameters& gate = {});

  /// Continues as `other` would, with a machine in the same state, on channels with the same frames.
  DriverCycle(const DriverCycle& other, Driver& driver, const Channels& channels);

  /// The number of this process; see SensorFrame::driver_instance.
  void set_driver_instance(std::uint64_t driver_instance) noexcept {
    driver_instance_ = calls_.law.process = driver_instance;
  }

  /// Announces a run in the head of the sensors channel and wakes its readers, so that they attach to it.
  /// `run`: random, not 0. Cycles count from 0.
  void begin_run(std::uint64_t run) noexcept;

  /// Stamp of cycle 0, ns. A later run of the same process begins one period after the last stamp or later.
  void set_start(std::int64_t stamp_ns) noexcept { start_ns_ = stamp_ns; }

  /// One tick. The first one of a run is cycle 0.
  void step() noexcept;

  /// Publishes the frame of the last tick again, as paused. Called after the other nodes have processed that frame;
  /// without effect before the first tick of a run.
  void publish_paused() noexcept { publish_last_as(DriverState::kPaused); }

  /// Publishes the frame of the last tick again, as ended: no tick follows. A reported fault stays reported.
  void publish_ended() noexcept { publish_last_as(DriverState::kEnded); }

  /// A simulated machine has these faults from the next tick on.
  void inject(const InjectedFaults& faults) noexcept;

  /// Wall clock: the next tick is due then. The part of its lag that has not slipped was held.
  void set_due(std::int64_t deadline_ns) noexcept {
    held_ns_ = static_cast<std::uint64_t>(deadline_ns - next_stamp_ns()) - slipped_ns_;
  }

  /// Wall clock: a pause has ended (SensorFrame::resumes).
  void count_resume() noexcept { ++resumes_; }

  /// Hardware, after its node was late: the next tick is that many cycles further on.
  void skip(std::uint64_t cycles) noexcept { cycle_ += cycles; }

  std::uint64_t run() const noexcept { return run_; }
  std::uint64_t next_cycle() const noexcept { return cycle_; }
  /// Wall clock, after the first tick: simulated over real time since the run began; time held is not counted.
  double real_time_factor() const noexcept;
  std::int64_t next_stamp_ns() const noexcept { return start_ns_ + static_cast<std::int64_t>(cycle_) * period_ns_; }
  void count_overrun() noexcept { ++overruns_; }
  void count_slip(std::int64_t slipped_ns) noexcept { slipped_ns_ += static_cast<std::uint64_t>(slipped_ns); }

  const DriverTrace& trace() const noexcept { return rows_.last(); }

  /// The law's state before the step of the last row, where it was copied; else null.
  const LawSnapshot* snapshot() const noexcept { return snapshots_.taken(); }

 private:
  DriverCycle(const DriverCycle& other) = default;
  GateInput latch(const SensorFrame& sensors) noexcept;
  void follow_resets(const GateInput& input) noexcept;
  void publish_last_as(DriverState state) noexcept;

  Driver* driver_;
  Simulator* simulator_;  ///< null before hardware
  Channels channels_;
  Gate gate_;
  std::int64_t period_ns_;
  Now now_;
  std::uint64_t driver_instance_ = 0;
  std::uint64_t run_ = 0;
  std::uint64_t cycle_ = 0;
  std::int64_t start_ns_ = 0;
  std::uint64_t overruns_ = 0;
  std::uint64_t slipped_ns_ = 0;
  std::uint64_t resumes_ = 0;
  std::uint64_t held_ns_ = 0;
  InjectedFaults injected_{};
  std::optional<std::uint64_t> resets_;  ///< Permit::resets_handled of the last permit
  SensorFrame paused_;
  CommandFrame command_;
  Permit permit_;
  GateCalls calls_ = first_row<GateCalls>();  ///< since the last row
  Snapshots snapshots_;
  Rows<DriverTrace> rows_;
};

}  // namespace robot_control
