#pragma once
/// The output of a node while a fault is injected into it (SensorFrame::injected): what is published instead.
///
///   off, slow, intermittent   where there is no output, a token: cycle k has passed here, without a frame
///   stuck, delayed            old content under the head of this cycle, so its own cycle numbers (a permit's expiry, a
///                             command's state_cycle) are old, too
///   garbage                   frame_distortion.h; one frame in four with a wrong checksum
///   wrong                     frame_distortion.h
///
/// Only the output fails: the node goes on computing. Between cycles a node with a fault publishes nothing. Nothing
/// here depends on the clock: a fault has the same effect in `clock: wall` as in lockstep, and in one process as in
/// four. A new run begins without the memory of the last one: a fault that is there in its first cycle begins in that
/// cycle.

#include <memory>

#include "faults/faulty_output.h"
#include "faults/frame_distortion.h"
#include "hal/frame_output.h"

namespace robot_control {

template <class Frame>
class FaultyFrameOutput final : public OutputDecorator<Frame> {
 public:
  explicit FaultyFrameOutput(FaultComponent component) noexcept
      : component_(component), output_(fault_seed(0, component)) {}

  bool publish(FrameWriter<Frame> channel, const FrameHead& head, const SensorFrame& sensors,
               Frame& frame) noexcept override {
    if (head.run != run_) output_.reset();
    run_ = head.run;
    bool broken = false;
    const auto distort_frame = [&broken](FaultKind kind, Frame& distorted, FaultRandom& random) {
      distort(kind, distorted, random);
      broken = kind == FaultKind::kGarbage && random.unit() < kBrokenShare;
    };
    const FaultKind kind = fault_of(sensors.injected, component_);
    if (output_.step(kind, head.cycle, frame, distort_frame) == Emission::kNothing) {
      publish_token(channel, head);
      return false;
    }
    if (kind == FaultKind::kOk) {
      channel.publish_sealed(frame);
      return true;
    }
    frame.head = head;
    seal(frame);
    if (broken) frame.head.checksum = ~frame.head.checksum;
    channel.publish_sealed(frame);
    return true;
  }

  bool may_publish_again(const SensorFrame& sensors) const noexcept override {
    return fault_of(sensors.injected, component_) == FaultKind::kOk;
  }

 private:
  static constexpr double kBrokenShare = 0.25;

  FaultComponent component_;
  std::uint64_t run_ = 0;
  FaultyOutput<Frame> output_;
};

inline OutputDecoratorPtr<StateFrame> faulty_estimator_output() {
  return std::make_unique<FaultyFrameOutput<StateFrame>>(FaultComponent::kEstimator);
}

inline OutputDecoratorPtr<CommandFrame> faulty_controller_output() {
  return std::make_unique<FaultyFrameOutput<CommandFrame>>(FaultComponent::kController);
}

inline OutputDecoratorPtr<Permit> faulty_monitor_output() {
  return std::make_unique<FaultyFrameOutput<Permit>>(FaultComponent::kMonitor);
}

}  // namespace robot_control
