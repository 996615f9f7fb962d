#pragma once
/// By how much the stamps of a sensor that samples evenly come too late or too early: of three readings in a row with
/// gaps g₁ and g₂ between them and independent errors of deviation σ, (g₂ − g₁)² is 6 σ² in the mean. A reading that
/// was lost is none of it: the difference counts as one gap at most.

#include <algorithm>
#include <cmath>

#include "estimation/tuning.h"
#include "estimation/values.h"

namespace robot_control {

class StampJitter {
 public:
  /// s, between this reading and the one before; > 0.
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
