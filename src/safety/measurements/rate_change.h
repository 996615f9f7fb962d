#pragma once
/// How much a gyro's rates change from sample to sample.
///
///   change = median of |ω_k − ω_{k−1}| over the last kSamples changes, rad/s
///
/// ω_k are the samples that differ from the one before: a gyro that is slower than the loop repeats its samples. A
/// median, because a single wrong sample causes two changes, and a foot that lands few: neither is an IMU that fails.
/// Before kSamples changes the missing ones are 0.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "signals/geometry.h"

namespace robot_control {

class RateChange {
 public:
  static constexpr std::size_t kSamples = 9;  ///< at 1 kHz the fifth jump in a row is found within 5 ms

  void reset() noexcept { *this = {}; }

  /// `rate`: ω, rad/s, finite, in any fixed axes of the body.
  void step(const Vector3& rate) noexcept {
    const double change = std::hypot(rate[0] - rate_[0], rate[1] - rate_[1], rate[2] - rate_[2]);
    rate_ = rate;
    if (!known_ || change == 0) {
      known_ = true;
      return;
    }
    changes_[next_] = change;
    next_ = (next_ + 1) % kSamples;
    std::array<double, kSamples> sorted = changes_;
    std::nth_element(sorted.begin(), sorted.begin() + kSamples / 2, sorted.end());
    value_ = sorted[kSamples / 2];
  }

  double value() const noexcept { return value_; }  ///< rad/s

 private:
  bool known_ = false;  ///< rate_
  Vector3 rate_{};      ///< rad/s, the last one
  std::array<double, kSamples> changes_{};
  std::size_t next_ = 0;
  double value_ = 0;
};

}  // namespace robot_control
