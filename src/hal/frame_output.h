#pragma once
/// The last step of a node's cycle: the frame is published.
///
/// The programs of a robot publish straight to the channel. A program for simulation is given a decorator
/// (faults/faulty_frame_output.h), which may change or withhold what the node has computed.

#include <memory>
#include <utility>

#include "rt/latest_frames.h"
#include "signals/frame_head.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// Cycle k has passed here, without a frame.
template <class Frame>
void publish_token(FrameWriter<Frame>& channel, const FrameHead& of) noexcept {
  Frame token{};
  token.head = {.run = of.run, .cycle = of.cycle, .stamp_ns = of.stamp_ns, .kind = FrameKind::kToken};
  channel.publish(token);
}

/// Stands between a node and its channel. Real-time safe.
template <class Frame>
class OutputDecorator {
 public:
  virtual ~OutputDecorator() = default;

  /// Publishes the frame of this cycle, or a token. `sensors`: of the same cycle. `frame`: sealed; afterwards what was
  /// published. False: a token was.
  virtual bool publish(FrameWriter<Frame> channel, const FrameHead& head, const SensorFrame& sensors,
                       Frame& frame) noexcept = 0;

  /// May the node publish once more in the same cycle?
  virtual bool may_publish_again(const SensorFrame& sensors) const noexcept = 0;
};

template <class Frame>
using OutputDecoratorPtr = std::unique_ptr<OutputDecorator<Frame>>;

/// `decorator` null: none.
template <class Frame>
class FrameOutput {
 public:
  FrameOutput(FrameWriter<Frame> channel, OutputDecoratorPtr<Frame> decorator) noexcept
      : channel_(channel), decorator_(std::move(decorator)) {
    channel_.memory()->head.decorated.store(decorator_ != nullptr ? 1 : 0);
  }

  /// As OutputDecorator::publish.
  bool publish(const FrameHead& head, const SensorFrame& sensors, Frame& frame) noexcept {
    complete(head, frame);
    if (decorator_ == nullptr) {
      channel_.publish_sealed(frame);
      return true;
    }
    if (decorator_->publish(channel_, head, sensors, frame)) return true;
    frame.head = head;
    frame.head.kind = FrameKind::kToken;
    return false;
  }

  /// Once more in the same cycle, with other content.
  void publish_again(const FrameHead& head, const SensorFrame& sensors, Frame& frame) noexcept {
    complete(head, frame);
    if (decorator_ == nullptr || decorator_->may_publish_again(sensors)) channel_.publish_sealed(frame);
  }

  /// Checksum of the frame that the node computed last, before the decorator changed it.
  std::uint64_t computed() const noexcept { return computed_; }

 private:
  void complete(const FrameHead& head, Frame& frame) noexcept {
    frame.head = head;
    seal(frame);
    computed_ = frame.head.checksum;
  }

  FrameWriter<Frame> channel_;
  OutputDecoratorPtr<Frame> decorator_;
  std::uint64_t computed_ = 0;
};

/// Any thread: does the writer of this channel publish through a decorator?
template <class Frame>
bool decorated(const FrameReader<Frame>& channel) noexcept {
  const auto* memory = channel.memory();
  return memory != nullptr && memory->head.decorated.load() != 0;
}

}  // namespace robot_control
