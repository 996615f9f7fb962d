#pragma once
/// SpeedLoop is the PI law with which a simulated drive closes the loop of its own speed, from the error e of the
/// speed:
///
///   τ = feed_forward + gain · (e + ∫ e dt / kIntegralTime), within ± limit
///
/// At the limit the integral keeps its value.

#include <algorithm>
#include <cmath>

namespace robot_control {

class SpeedLoop {
 public:
  static constexpr double kIntegralTime = 0.2;  ///< s

  void reset() { integral_ = 0; }

  /// Returns τ in N·m. `gain` is in N·m·s/rad, `limit` in N·m, `seconds` the time since the last step.
  double step(double error, double gain, double limit, double seconds, double feed_forward = 0) {
    const double integral = integral_ + gain / kIntegralTime * error * seconds;
    const double wanted = feed_forward + gain * error + integral;
    if (std::abs(wanted) < limit) integral_ = integral;
    return std::clamp(wanted, -limit, limit);
  }

 private:
  double integral_ = 0;  // N·m
};

}  // namespace robot_control
