#pragma once
/// All inputs of one cycle of the monitor.

#include "signals/command_frame.h"
#include "signals/sensor_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// Null: missing in this cycle.
struct MonitorInput {
  const SensorFrame* sensors = nullptr;   ///< never null
  const CommandFrame* command = nullptr;  ///< of cycle k-1
  bool state_seen = false;                ///< a state of cycle k-1 exists; only the next member of it is used
  std::uint64_t state_first_cycle = 0;    ///< StateFrame::first_cycle
  bool corrupt = false;                   ///< a checksum of this cycle's inputs was wrong
  OperatorInput operator_input;
};

}  // namespace robot_control
