#pragma once
/// The trace has one row per cycle and node for the log: the published frame, its time, and the inputs of the law. If
/// an injected fault suppressed the frame, its head is that of a token, and its content was not published.

#include <cstdint>

#include "signals/command_frame.h"
#include "signals/law_calls.h"
#include "signals/live_tuning.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/truth_frame.h"

namespace robot_control {

/// Returns when cycle k was due on the wall clock: its stamp plus the delays (`slipped_ns`) and pauses (`held_ns`) of a
/// simulated plant.
inline std::int64_t due_ns(const SensorFrame& sensors) noexcept {
  return sensors.head.stamp_ns + static_cast<std::int64_t>(sensors.slipped_ns + sensors.held_ns);
}

/// Times relative to `due_ns`, on the same clock. They are zero in lockstep, where no time passes within a cycle.
struct CycleTiming {
  std::int64_t woke_ns = 0;       ///< the thread began this cycle
  std::int64_t published_ns = 0;  ///< its frame was published
};

struct DriverTrace {
  SensorFrame sensors;
  TruthFrame truth;
  GateReport gate;  ///< report of tick k itself (SensorFrame::gate is that of the last one)
  CycleTiming timing;
  GateCalls calls;
};

struct EstimatorTrace {
  StateFrame state;
  CycleTiming timing;
  EstimatorCalls calls;
};

struct ControllerTrace {
  CommandFrame command;
  LiveTuning tuning;  ///< the tuning with which the command was computed
  CycleTiming timing;
  ControllerCalls calls;
};

struct MonitorTrace {
  Permit permit;
  CycleTiming timing;
  MonitorCalls calls;
};

/// Return the head of the row's frame, published or suppressed.
inline const FrameHead& head_of(const DriverTrace& row) noexcept {
  return row.sensors.head;
}
inline const FrameHead& head_of(const EstimatorTrace& row) noexcept {
  return row.state.head;
}
inline const FrameHead& head_of(const ControllerTrace& row) noexcept {
  return row.command.head;
}
inline const FrameHead& head_of(const MonitorTrace& row) noexcept {
  return row.permit.head;
}

}  // namespace robot_control
