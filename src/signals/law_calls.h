#pragma once
/// These structs hold the inputs of each law in one cycle, except the frames in the rows of the other nodes. With those
/// rows they suffice to run the law again bit for bit.
///
/// The checksum identifies a frame that a law used: a node may publish twice in one cycle, and another process may take
/// its place. If an injected fault changed a frame, `LawRow::output` belongs to the healthy frame, and the row holds
/// the published one.

#include <cstdint>

#include "signals/frame_head.h"
#include "signals/geometry.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// The result of looking up a frame.
struct UsedFrame {
  Lookup found = Lookup::kMissing;
  std::uint64_t cycle = 0;     ///< cycle of the frame, if it was found
  std::uint64_t checksum = 0;  ///< FrameHead::checksum, if it was found
};

template <class Frame>
UsedFrame used(Lookup found, const Frame& frame) noexcept {
  if (found != Lookup::kFrame) return {.found = found};
  return {.found = found, .cycle = frame.head.cycle, .checksum = frame.head.checksum};
}

/// The part of a row that all laws have.
struct LawRow {
  std::uint64_t process = 0;  ///< random number of the process that ran the law
  std::uint64_t number = 0;   ///< number of rows of this process before this one; a gap means lost rows
  std::uint64_t output = 0;   ///< checksum of the law's output under the head of its cycle
  std::uint64_t sensors = 0;  ///< checksum of the sensor frame of this cycle
  std::uint64_t new_run = 0;  ///< 1: `enter_run` was called since the row before
};

struct GateCalls {
  LawRow law;  ///< `output`: digest_of(commands, report)
  UsedFrame command;
  UsedFrame permit;
};

struct EstimatorCalls {
  LawRow law;
  std::uint64_t first_cycle = 0;  ///< StateFrame::first_cycle
  std::uint64_t pose_set = 0;     ///< 1: set_pose(pose) was called before the step
  Vector3 pose{};                 ///< x [m], y [m], yaw [rad]
};

/// `permit` had not expired.
struct ControllerCalls {
  LawRow law;
  std::uint64_t with_zero = 0;  ///< argument of `enter_run`
  std::uint64_t tuned = 0;      ///< 1: tune(ControllerTrace::tuning) was called before the step
  VelocityCommand inbox;        ///< argument of `enter_run`
  VelocityCommand request;
  std::uint64_t state = 0;  ///< checksum of the state frame of this cycle
  UsedFrame permit;
};

/// Why the monitor made a step without a sensor frame.
enum class SensorSilence : std::uint64_t {
  kNone = 0,      ///< the step has a sensor frame, or the next one is not due yet
  kPaused = 1,    ///< the driver reported that it is paused
  kEnded = 2,     ///< the driver reported its end
  kTimedOut = 3,  ///< wall clock: no current frame for loss_cycles periods, from a driver that reported neither
};

/// A step of the monitor has a sensor frame, or LawRow::sensors is 0 and the head of the permit is that of the step
/// before.
struct MonitorCalls {
  LawRow law;
  SensorSilence silence = SensorSilence::kNone;
  UsedFrame command, state;  ///< of the cycle before
  std::uint64_t corrupt = 0;
  OperatorInput operator_input;
};

}  // namespace robot_control
