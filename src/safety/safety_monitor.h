#pragma once
/// safety_monitor's law: facts of one cycle → permit of that cycle.

#include <cstdint>

#include "signals/command_frame.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

struct SafetyParameters {
  std::uint64_t loss_cycles = 20;   ///< cycles without a command or a state before the stop latches
  double heartbeat_timeout = 0;     ///< s; 0 = no operator heartbeat is asked for
  double ramp_time = 2.0;           ///< s, longest category-1 ramp before the brake
  double standstill_speed = 0.05;   ///< rad/s, wheels slower than this are standing
};

/// Everything that one cycle depends on. Null: missing in this cycle.
struct MonitorInput {
  const SensorFrame* sensors = nullptr;   ///< never null
  const CommandFrame* command = nullptr;  ///< of cycle k-1
  bool state_seen = false;                ///< a state of cycle k-1 exists (its head alone was read)
  bool corrupt = false;                   ///< a checksum of this cycle's inputs was wrong
  OperatorInput operator_input;
};

class SafetyMonitor {
 public:
  SafetyMonitor(const SafetyParameters& parameters, double period);

  /// A new run: sightings and counts begin anew; latched causes stay. `operator_input` is the inbox now.
  void reset(const OperatorInput& operator_input) noexcept;

  /// After a restart of the monitor: `last` is what the channel still holds.
  void resume(const Permit& last) noexcept;

  /// The driver has been silent for 20 periods (wall clock only): latches kCauseDriverLost.
  void driver_lost() noexcept;

  /// Fills everything but `out.head`.
  void step(const MonitorInput& input, Permit& out) noexcept;
};

}  // namespace robot_control
