#pragma once
/// Facts of one cycle → StopCause bits that are true in it. Holds the counters that give a fact its persistence.
///
///   e-stop topic      level true, or its trigger counter changed      | service  its counter changed
///   e-stop input      kInputEmergencyStop                             | fault    driver_state kFault or faults ≠ 0
///   estimator lost    k − k_seen ≥ loss_cycles, from the first state of this run on
///   controller lost   the same of commands, while states come: without a state there is no command to miss
///   monitor late      k − k_last > loss_cycles between two steps of one run: others would have been judged too late
///   heartbeat lost    k − k_beat > timeout, in cycles. Counting begins at the first beat of this run, or at the
///                     first cycle of motion without one (state DRIVE): a robot that was never asked to move
///                     needs no operator, and one that moves needs one within the timeout.
///   corrupt, not finite          kPersistence cycles in a row: a single one only costs the gate's brake
///
/// Counts are of cycles, not of looks: a monitor that skips cycles is no slower to see a loss.
/// An emergency stop is never dropped: one that arrived between two runs is active in the first cycle of the new one.

#include <cstdint>

#include "safety/monitor_input.h"
#include "safety/safety_parameters.h"
#include "signals/permit.h"
#include "signals/velocity_command.h"

namespace robot_control {

class Conditions {
 public:
  static constexpr std::uint64_t kPersistence = 3;  ///< cycles

  Conditions(const SafetyParameters& parameters, double period);

  /// A new run: sightings and counts begin anew. Heartbeats received before it are not beats of this run.
  void enter_run(const OperatorInput& operator_input) noexcept;

  /// After a restart of the monitor: the topic e_stop counts as true until its next message.
  void hold_e_stop() noexcept { e_stop_held_ = true; }

  /// `driving`: the state before this cycle is DRIVE. True causes of this cycle; call once per cycle.
  std::uint64_t step(const MonitorInput& input, bool driving) noexcept;

  /// MissingNode bits: not seen in this run.
  std::uint64_t missing() const noexcept { return missing_; }

 private:
  std::uint64_t operator_causes(const OperatorInput& operator_input) noexcept;
  bool heartbeat_lost(std::uint64_t heartbeats, std::uint64_t cycle, bool driving) noexcept;

  std::uint64_t loss_cycles_;
  std::uint64_t heartbeat_cycles_;  ///< 0 = off
  std::uint64_t missing_ = kMissingSensors | kMissingState | kMissingCommand;
  bool stepped_ = false;            ///< in this run
  std::uint64_t last_cycle_ = 0;    ///< of the last step
  std::uint64_t command_seen_ = 0;  ///< last cycle with a command, or without a state
  std::uint64_t state_seen_ = 0;    ///< last cycle with a state
  std::uint64_t corrupt_ = 0;
  std::uint64_t not_finite_ = 0;
  bool e_stop_held_ = false;
  bool heartbeat_counts_ = false;
  std::uint64_t beat_cycle_ = 0;
  OperatorInput seen_;  ///< the counters as last looked at
};

}  // namespace robot_control
