#pragma once
/// MotionScale compares the velocity that a motor reports with its positions. Both are scaled by a range of the drive
/// file, and a wrong range gives them different scales.
///
/// A step ends when the motor turned by kStep. D is the change of the position in it, and I the integral of the
/// velocity by the trapezoidal rule. The ratio over the steps of a window is
///
///   r = Σ I D / Σ D² = (V of the file / V of the motor) / (P of the file / P of the motor)
///
/// A window lasts until its steps have turned by kTravel together, and for kMinWindow or more. The scale is wrong if r
/// is outside of 1/kMaxRatio … kMaxRatio in kWindows windows in a row. A filter of 5 ms of the velocity lowers r by 3 %
/// at 8 Hz; frames that are late by a period disturb I at random. Ranges that are wrong by the same factor are not
/// found.
///
/// A step begins again after kMaxSpan, so that an offset of the velocity is not integrated at rest. It also begins
/// again after a gap between two samples, and near the end of a range.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "drivers/drive/mit/mit_codec.h"

namespace robot_control {

class MotionScale {
 public:
  static constexpr double kStep = 0.02;      ///< rad, of the shaft: 50 steps of a position of 16 bits in 25 rad
  static constexpr double kMinSpan = 0.02;   ///< s: 20 times the delay of a late frame at 1 kHz
  static constexpr double kMaxSpan = 0.05;   ///< s; half a step of a velocity of 12 bits in 100 rad/s is 3 % of kStep
  static constexpr double kMaxGap = 0.01;    ///< s
  static constexpr double kTravel = 0.5;     ///< rad
  static constexpr double kMinWindow = 0.3;  ///< s of steps: a filter shifts the reversals of a faster swing
  static constexpr int kWindows = 2;
  static constexpr double kMaxRatio = 1.2;
  static constexpr double kUsed = 0.98;  ///< of a range

  explicit MotionScale(const MitRanges& ranges) noexcept : ranges_(ranges) {}

  void clear() noexcept { *this = MotionScale(ranges_); }

  /// Takes a sample in rad and rad/s, and returns whether the scale is wrong.
  bool step(double position, double velocity, std::int64_t now_ns) noexcept {
    const double elapsed = 1.0e-9 * static_cast<double>(now_ns - stamp_ns_);
    const bool ends = std::abs(position) > kUsed * ranges_.position || std::abs(velocity) > kUsed * ranges_.velocity;
    integral_ += 0.5 * (velocity + velocity_) * elapsed;
    span_ += elapsed;
    stamp_ns_ = now_ns;
    velocity_ = velocity;
    if (ends || !(elapsed <= kMaxGap) || span_ > kMaxSpan) begin(position);
    const double moved = position - begin_;
    const double turned = std::max(std::abs(moved), std::abs(integral_));
    if (span_ < kMinSpan || turned < kStep) return false;
    product_ += integral_ * moved;
    square_ += moved * moved;
    travel_ += turned;
    time_ += span_;
    begin(position);
    if (travel_ < kTravel || time_ < kMinWindow) return false;
    ratio_ = square_ > 0 ? product_ / square_ : 0;
    product_ = square_ = travel_ = time_ = 0;
    wrong_ = 1 / kMaxRatio <= ratio_ && ratio_ <= kMaxRatio ? 0 : wrong_ + 1;
    return wrong_ >= kWindows;
  }

  /// Returns r of the last window; 1 without one, 0 where the position stayed.
  double ratio() const noexcept { return ratio_; }

 private:
  void begin(double position) noexcept {
    begin_ = position;
    integral_ = span_ = 0;
  }

  MitRanges ranges_;
  double begin_ = 0;     // rad, of this step
  double integral_ = 0;  // rad, I
  double span_ = 0;      // s
  double velocity_ = 0;
  std::int64_t stamp_ns_ = 0;
  double product_ = 0, square_ = 0;  // rad²
  double travel_ = 0;                // rad, of this window
  double time_ = 0;                  // s, of its steps
  double ratio_ = 1;
  int wrong_ = 0;  // windows in a row
};

}  // namespace robot_control
