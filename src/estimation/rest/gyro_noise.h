#pragma once
/// White noise density of the gyro about z, learned from rests: the Allan variance of its means over one window of the
/// rest watch, m₁, m₂, … of T s each (IEEE Std 952-1997, annex C):
///
///   n² = max(n₀², (N (kMountedGyro n₀)² + Σ T (m_k+1 − m_k)²/2) / (N + count))      n₀: of the data sheet, N:
///   kNoisePrior
///
/// No gyro on a robot is quieter than its data sheet, and most are louder: recordings show 3.5 … 4.5e-4 where it states
/// 2.4e-4.

#include <algorithm>
#include <cmath>

#include "estimation/tuning.h"
#include "estimation/values.h"

namespace robot_control {

class GyroNoise {
 public:
  /// rad/s/√Hz
  explicit GyroNoise(double data_sheet = 0) noexcept : data_sheet_(data_sheet) {}

  /// The mean of the next window, rad/s over s.
  void add(double mean, double window) noexcept {
    if (known_) {
      sum_ += window * square(mean - last_) / 2;
      ++count_;
    }
    last_ = mean;
    known_ = true;
  }
  /// The next window does not follow the last one.
  void interrupt() noexcept { known_ = false; }

  double density() const noexcept {  ///< rad/s/√Hz
    const double prior = Tuning::kNoisePrior * square(Tuning::kMountedGyro * data_sheet_);
    return std::sqrt(std::max(square(data_sheet_), (prior + sum_) / (Tuning::kNoisePrior + count_)));
  }

 private:
  double data_sheet_;
  double sum_ = 0;    ///< (rad/s)²·s
  double count_ = 0;  ///< of differences
  double last_ = 0;   ///< rad/s
  bool known_ = false;
};

}  // namespace robot_control
