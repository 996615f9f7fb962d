#pragma once
/// A Kalman filter of one state estimates a bias that walks and is measured directly.

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

}  // namespace robot_control
