#pragma once
/// The monitor's duty in one cycle: sensors k (which woke it), command k-1, head of state k-1 → permit k.
/// A token is passed on. Told to fail, it does (faulty_writer.h); then it has nothing to say out of turn.

#include <cstdint>

#include "robot/robot_model.h"
#include "rt/latest_frames.h"
#include "rt/latest_value.h"
#include "runtime/command_script.h"
#include "runtime/cycle_clock.h"
#include "runtime/faulty_writer.h"
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

  /// True when there was a new sensor frame of the driver's current run, and a permit was published.
  bool step() noexcept;

  /// Wall clock: a whole wait for sensors has passed and nothing woke it. Unless the driver's last word was "paused",
  /// that latches kCauseDriverLost, and the last permit is published again with it, for display. Then as `idle`.
  void silence() noexcept;

  /// No frame has come for a while: answers resets, with a refusal, and emergency stops, with the latch.
  void idle() noexcept;

  const MonitorTrace& trace() const noexcept { return trace_; }

 private:
  void enter_run() noexcept;
  void receive_messages() noexcept;
  void note_corrupt_sensors() noexcept;
  void note_pause() noexcept;
  void receive(std::uint64_t cycle) noexcept;
  void publish_again() noexcept;
  FrameHead head() const noexcept;

  SafetyMonitor monitor_;
  CycleClock clock_;
  Channels channels_;
  FaultyWriter<Permit> out_{FaultComponent::kMonitor};
  CommandScript script_;
  std::uint64_t robot_hash_;
  LatestValue<OperatorInput> inbox_;
  OperatorInput received_;        ///< what the inbox held when last looked at
  OperatorInput operator_input_;  ///< inbox and script added up
  bool silent_ = false;
  std::uint64_t corrupt_sensors_ = 0;  ///< in a row
  SensorFrame arrived_;                ///< as read, not yet believed
  SensorFrame sensors_;                ///< of the last step
  StateFrame state_;
  CommandFrame command_;
  MonitorInput input_;
  MonitorTrace trace_;
};

}  // namespace robot_control
