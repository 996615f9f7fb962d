#pragma once
/// A bias that walks and is measured directly: a Kalman filter of one state.

namespace robot_control {

struct BiasEstimate {
  double value = 0;
  double variance = 0;

  /// `measured` with the variance `noise`; `walk`: variance that was added since the last measurement.
  void measure(double measured, double noise, double walk) noexcept {
    variance += walk;
    const double gain = variance / (variance + noise);
    value += gain * (measured - value);
    variance *= 1 - gain;
  }
};

}  // namespace robot_control
