#pragma once
/// Learns the errors of the stamps of a sensor that samples evenly. With gaps g₁ and g₂ between three readings and
/// independent errors of deviation σ, the mean of (g₂ − g₁)² is 6 σ². The difference counts as one gap at most, so that
/// a lost reading does not count as jitter.

#include <algorithm>
#include <cmath>

#include "estimation/tuning.h"
#include "estimation/values.h"

namespace robot_control {

class StampJitter {
 public:
  /// Adds the gap between this reading and the one before, in s, > 0.
  void add(double gap) noexcept {
    const double difference = std::min(std::abs(gap - last_), std::min(gap, last_));
    if (last_ > 0) {
      count_ = std::min(count_ + 1, Tuning::kStampMemory);
      variance_ += (square(difference) / 6 - variance_) / count_;
    }
    last_ = gap;
  }

  double variance() const noexcept { return variance_; }  ///< s²

 private:
  double last_ = 0;  ///< s
  double variance_ = 0;
  double count_ = 0;
};

}  // namespace robot_control
