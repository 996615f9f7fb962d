#pragma once
/// The last step of a node's cycle: publishes the frame or, while a fault is injected (SensorFrame::injected), the
/// faulty output.
///
///   no output (off, slow, intermittent)   a token: cycle k was processed without a frame
///   stuck, delayed                        old content under the head of this cycle, so its own cycle numbers
///                                         (a permit's expiry, a command's state_cycle) are old, too
///   garbage                               spoilt_frames.h; one frame in four with a wrong checksum
///   wrong                                 spoilt_frames.h
///
/// Only the output is faulty: the law continues. Nothing here depends on the clock: a failing node does the same in
/// `clock: wall` as in lockstep, and in one process as in four. A new run restarts: a fault that is
/// injected in its first cycle begins in that cycle.

#include "hal/faulty_output.h"
#include "rt/latest_frames.h"
#include "runtime/cycles/cycle_clock.h"
#include "runtime/spoilt_frames.h"

namespace robot_control {

template <class Frame>
class FaultyWriter {
 public:
  explicit FaultyWriter(FaultComponent component) noexcept : component_(component), output_(fault_seed(0, component)) {}

  /// `frame`: complete but for its head; afterwards what was published. False: a token was. Real-time safe.
  bool publish(FrameWriter<Frame> channel, const FrameHead& head, const InjectedFaults& faults, Frame& frame) noexcept {
    if (head.run != run_) output_.reset();
    run_ = head.run;
    bool broken = false;
    const auto spoil_frame = [&broken](FaultKind kind, Frame& spoilt, FaultRandom& random) {
      spoil(kind, spoilt, random);
      broken = kind == FaultKind::kGarbage && random.unit() < kBrokenShare;
    };
    if (output_.step(fault_of(faults, component_), head.cycle, frame, spoil_frame) == Emission::kNothing) {
      publish_token(channel, head);
      return false;
    }
    frame.head = head;
    if (broken) {
      channel.publish_broken(frame);
    } else {
      channel.publish(frame);
    }
    return true;
  }

  FaultComponent component() const noexcept { return component_; }

 private:
  static constexpr double kBrokenShare = 0.25;

  FaultComponent component_;
  std::uint64_t run_ = 0;
  FaultyOutput<Frame> output_;
};

}  // namespace robot_control
