#pragma once
/// A Kalman filter of one state estimates a bias that walks and is measured directly.

#include <utility>

namespace robot_control {

struct BiasEstimate {
  double value = 0;
  double variance = 0;

  /// Updates with `measured` of the variance `noise`. `walk` is the variance added since the last measurement.
  void measure(double measured, double noise, double walk) noexcept {
    variance += walk;
    const double gain = variance / (variance + noise);
    value += gain * (measured - value);
    variance *= 1 - gain;
  }
};

/// Measures the noise density of a gyro at rest by the differences of successive samples.
class RestNoise {
 public:
  explicit RestNoise(double expected) noexcept : sum_(kExpected * expected * expected) {}

  /// `sample` is in rad/s, `gap` s after the one before.
  void add(double sample, double gap, bool rests) noexcept {
    const double change = sample - std::exchange(last_, sample);
    if (!std::exchange(rested_, rests) || !rests) return;
    sum_ += change * change * gap / 2;
    count_ += 1;
  }
  double squared() const noexcept { return sum_ / count_; }  ///< (rad/s)²/Hz

 private:
  static constexpr double kExpected = 8;  ///< samples that the expected density counts for
  double sum_;
  double count_ = kExpected;
  double last_ = 0;
  bool rested_ = false;
};

}  // namespace robot_control
