#pragma once
/// LatePosition is the position of a joint whose samples arrive late by a time that changes from frame to frame, as
/// through a USB adapter.
///
/// A position q that arrives at t was sampled between t − L and t, so the joint is now between q and q + v·L. The
/// position of the frame before is moved on with the velocity v, and then clamped to these bounds. A late frame thus no
/// longer moves a turning joint, and a joint at rest has the position q itself.
///
/// Two frames that arrive d earlier after each other than their period prove that the first was late by d. L is twice
/// the largest d of the last kFrames to 2 · kFrames frames, because the request may be late as well as its answer. It
/// is at most two periods. On a bus that is in time L is nearly 0 and q is taken as it arrives.

#include <algorithm>
#include <cstdint>

namespace robot_control {

class LatePosition {
 public:
  static constexpr int kFrames = 256;

  /// `period_ns` is the time between two samples.
  explicit LatePosition(std::int64_t period_ns) noexcept : period_ns_(period_ns) {}

  /// Forgets all samples.
  void clear() noexcept { *this = LatePosition(period_ns_); }

  /// Takes the sample that arrived at `now_ns`, and returns the position at this time. Any unit of angle or length;
  /// `velocity` per second.
  double step(double position, double velocity, std::int64_t now_ns) noexcept {
    if (stamp_ns_ == kNoSample) {
      position_ = position;
    } else {
      note_interval(now_ns - stamp_ns_);
      const double predicted = position_ + velocity * 1.0e-9 * static_cast<double>(now_ns - stamp_ns_);
      const double moved = position + velocity * 1.0e-9 * static_cast<double>(lateness_ns());
      position_ = std::clamp(predicted, std::min(position, moved), std::max(position, moved));
    }
    stamp_ns_ = now_ns;
    return position_;
  }

  /// Returns L.
  std::int64_t lateness_ns() const noexcept { return 2 * std::max(largest_ns_, largest_before_ns_); }

 private:
  static constexpr std::int64_t kNoSample = -1;

  void note_interval(std::int64_t interval_ns) noexcept {
    largest_ns_ = std::max(largest_ns_, period_ns_ - interval_ns);
    if (++frames_ < kFrames) return;
    largest_before_ns_ = largest_ns_;
    largest_ns_ = 0;
    frames_ = 0;
  }

  std::int64_t period_ns_;
  double position_ = 0;
  std::int64_t stamp_ns_ = kNoSample;
  std::int64_t largest_ns_ = 0;         // d of this block of frames
  std::int64_t largest_before_ns_ = 0;  // and of the block before
  int frames_ = 0;                      // of this block
};

}  // namespace robot_control
