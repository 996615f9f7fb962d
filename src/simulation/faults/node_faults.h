#pragma once
/// NodeFaults replaces the output of a node while a fault is injected into it (SensorFrame::injected). ClosedLoop
/// leaves the replacement in the node's channel.
///
///   off, slow, intermittent   a token in cycles without output: cycle k has passed here without a frame
///   stuck, delayed            old content under the head of this cycle; its own cycle numbers (a permit's expiry, a
///                             command's state_cycle) are also old
///   garbage                   `distort`; one frame in four with a wrong checksum
///   wrong                     `distort`
///
/// Only the output fails; the node continues to compute. A new run begins without the state of the last one: a fault
/// that is present in its first cycle begins in that cycle.

#include <cstdint>

#include "bus/latest_frames.h"
#include "signals/command_frame.h"
#include "signals/frame_head.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/trace.h"
#include "simulation/faults/faulty_output.h"

namespace robot_control {

/// Corrupts the output frames of a node for the injected faults kGarbage and kWrong (signals/injected_fault.h).
///
///              kGarbage                                          kWrong
///   state      every number of pose, twist and bias              x, y and speeds with the opposite sign
///   command    every number and the mode of every joint          every effort, speed and angle with the opposite sign
///   permit     a random action, state and causes                 drives instead of braking, brakes instead of driving
///
/// A garbage number is uniform within ±kGarbage; one in eight is NaN, one in eight infinite. A wrong frame is finite
/// and plausible, and its flags are those of a healthy one. The caller fills in the heads.
inline constexpr double kGarbage = 1000;

void distort(FaultKind kind, StateFrame& state, FaultRandom& random) noexcept;
void distort(FaultKind kind, CommandFrame& command, FaultRandom& random) noexcept;
void distort(FaultKind kind, Permit& permit, FaultRandom& random) noexcept;

/// `Row` is the node's row of the trace, `kFrame` the row's member with the published frame.
template <class Frame, class Row, Frame Row::*kFrame>
class NodeFaults {
 public:
  NodeFaults(FaultComponent component, FrameWriter<Frame> channel) noexcept
      : component_(component), channel_(channel), output_(fault_seed(0, component)) {}

  /// Continues as `other` would, on a channel with the same frames.
  NodeFaults(const NodeFaults& other, FrameWriter<Frame> channel) noexcept : NodeFaults(other) { channel_ = channel; }

  /// Is called after the node has published the frame in `row`, computed from `sensors`, and before another node reads
  /// it. If there is a fault, it replaces the frame in the channel. It returns the row with the frame that the channel
  /// now holds.
  const Row* replace(const SensorFrame& sensors, const Row& row) noexcept {
    const FrameHead& published = (row.*kFrame).head;
    const FrameHead head{.run = published.run, .cycle = published.cycle, .stamp_ns = published.stamp_ns};
    const FaultKind kind = fault_of(sensors.injected, component_);
    if (kind == FaultKind::kOk || head.run != run_) output_.reset();
    run_ = head.run;
    if (kind == FaultKind::kOk) return &row;
    row_ = row;
    bool broken = false;
    const auto distort_frame = [&broken](FaultKind how, Frame& distorted, FaultRandom& random) {
      distort(how, distorted, random);
      broken = how == FaultKind::kGarbage && random.unit() < kBrokenShare;
    };
    Frame& frame = row_.*kFrame;
    const Emission emission = output_.step(kind, head.cycle, frame, distort_frame);
    frame.head = head;
    if (emission == Emission::kNothing) {
      frame.head.kind = FrameKind::kToken;
      channel_.publish_token(head);
      return &row_;
    }
    seal(frame);
    if (broken) frame.head.checksum = ~frame.head.checksum;
    channel_.publish_sealed(frame);
    return &row_;
  }

 private:
  NodeFaults(const NodeFaults& other) = default;
  static constexpr double kBrokenShare = 0.25;

  FaultComponent component_;
  FrameWriter<Frame> channel_;
  std::uint64_t run_ = 0;
  FaultyOutput<Frame> output_;
  Row row_;  ///< row of the last cycle with a fault
};

using EstimatorFaults = NodeFaults<StateFrame, EstimatorTrace, &EstimatorTrace::state>;
using ControllerFaults = NodeFaults<CommandFrame, ControllerTrace, &ControllerTrace::command>;
using MonitorFaults = NodeFaults<Permit, MonitorTrace, &MonitorTrace::permit>;

}  // namespace robot_control
