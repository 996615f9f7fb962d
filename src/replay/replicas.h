#pragma once
/// The four laws of a log, each with the state it has reached in its replay.

#include "control/drive_controller.h"
#include "estimation/estimator.h"
#include "hal/gate.h"
#include "parameters/parameters.h"
#include "replay/continuity.h"
#include "replay/frame_history.h"
#include "robot/robot_model.h"
#include "safety/safety_monitor.h"
#include "signals/trace.h"

namespace robot_control {

/// What was published, found by checksum.
struct PublishedFrames {
  FrameHistory<SensorFrame> sensors;
  FrameHistory<StateFrame> state;
  FrameHistory<CommandFrame> command;
  FrameHistory<Permit> permit;
};

/// The sensor frame that a node used, as the driver published it or, as paused or ended, published it again.
inline bool sensors_of(const FrameHistory<SensorFrame>& published, const FrameHead& of, std::uint64_t checksum,
                       SensorFrame& out) {
  const SensorFrame* found = published.find(checksum);
  const bool again = found == nullptr;
  if (again) found = published.find(of.run, of.cycle);
  if (found == nullptr) return false;
  out = *found;
  if (!again) return true;
  for (const DriverState state : {DriverState::kPaused, DriverState::kEnded}) {
    out.driver_state = state;
    seal(out);
    if (out.head.checksum == checksum) return true;
  }
  return false;
}

struct GateReplica {
  Gate law;
  Continuity continuity;
};

struct EstimatorReplica {
  Estimator law;
  Continuity continuity;
  StateFrame output;
};

struct ControllerReplica {
  DriveController law;
  Continuity continuity;
  CommandFrame output;
};

struct MonitorReplica {
  SafetyMonitor law;
  Continuity continuity;
  Permit output;
  SensorFrame sensors;  ///< of the last step
  CommandFrame command;
  MonitorInput input;
  FrameHead head;                     ///< of the last step
  std::uint64_t applied_process = 0;  ///< of the row whose events are applied ahead of its step
  std::uint64_t applied_number = 0;   ///< its number, plus 1
};

}  // namespace robot_control
