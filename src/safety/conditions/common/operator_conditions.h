#pragma once
/// Conditions on the operator's inputs: emergency stops and the heartbeat.
///
///   e-stop topic    level true, or its trigger counter changed      | service  its counter changed
///   e-stop input    kInputEmergencyStop
///   heartbeat lost  k − k_beat > timeout, in cycles. Counting begins with the first heartbeat of this run, or with the
///                   first cycle of state DRIVE without one: a robot at rest needs no operator, a driving one needs a
///                   heartbeat within the timeout.
///
/// An emergency stop is never dropped: one that arrived between two runs is active in the first cycle of the new one.

#include <cstdint>

#include "safety/latch/active_causes.h"
#include "safety/monitor_input.h"
#include "signals/velocity_command.h"

namespace robot_control {

class OperatorConditions {
 public:
  /// `heartbeat_timeout`, `period` s.
  OperatorConditions(double heartbeat_timeout, double period) noexcept;

  /// A new run. Heartbeats received before it do not count.
  void enter_run(const OperatorInput& operator_input) noexcept;

  /// After a restart of the monitor: a topic e_stop that was active counts as true until its next message.
  void restore(std::uint64_t active) noexcept {
    if ((active & kCauseEmergencyStopTopic) != 0) e_stop_held_ = true;
  }

  /// `driving`: the state before this cycle is DRIVE. Without a sensor frame only topic and service are evaluated.
  void step(const MonitorInput& input, bool driving, ActiveCauses& out) noexcept;

 private:
  /// StopCause bits of the topic and the service; each event is reported once.
  std::uint64_t emergency_stops(const OperatorInput& operator_input) noexcept;
  bool heartbeat_lost(std::uint64_t heartbeats, std::uint64_t cycle, bool driving) noexcept;

  double period_;
  double heartbeat_timeout_;
  std::uint64_t heartbeat_cycles_;  ///< 0 = off
  bool e_stop_held_ = false;
  bool heartbeat_counts_ = false;
  std::uint64_t beat_cycle_ = 0;
  OperatorInput seen_;  ///< the counters at the last step
};

}  // namespace robot_control
