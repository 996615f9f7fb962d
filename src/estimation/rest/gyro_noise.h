#pragma once
/// Learns the white noise density of the gyro about z from rests. It is the Allan variance (IEEE Std 952-1997, annex C)
/// of the means m₁, m₂, … over the windows of the rest watch, of T s each:
///
///   n² = max(n₀², (N (kMountedGyro n₀)² + Σ T (m_k+1 − m_k)²/2) / (N + count))
///
/// n₀ is the density of the data sheet and N is kNoisePrior. A gyro on a robot is louder than its data sheet:
/// recordings show 3.5 … 4.5e-4 where it states 2.4e-4.

#include <algorithm>
#include <cmath>

#include "estimation/tuning.h"
#include "estimation/values.h"

namespace robot_control {

class GyroNoise {
 public:
  /// `data_sheet` is in rad/s/√Hz.
  explicit GyroNoise(double data_sheet = 0) noexcept : data_sheet_(data_sheet) {}

  /// Adds the mean of the next window: rad/s over s.
  void add(double mean, double window) noexcept {
    if (known_) {
      sum_ += window * square(mean - last_) / 2;
      ++count_;
    }
    last_ = mean;
    known_ = true;
  }
  /// States that the next window does not follow the last one.
  void interrupt() noexcept { known_ = false; }

  double density() const noexcept {  ///< rad/s/√Hz
    const double prior = Tuning::kNoisePrior * square(Tuning::kMountedGyro * data_sheet_);
    return std::sqrt(std::max(square(data_sheet_), (prior + sum_) / (Tuning::kNoisePrior + count_)));
  }

 private:
  double data_sheet_;
  double sum_ = 0;    ///< (rad/s)²·s
  double count_ = 0;  ///< number of differences
  double last_ = 0;   ///< rad/s
  bool known_ = false;
};

}  // namespace robot_control
