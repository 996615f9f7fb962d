#pragma once
/// SpeedLead is the order to a wheel whose drive closes the loop of its speed by a PI law and takes no torque.
///
/// In a ramp the integral of such a drive takes over the torque of the acceleration a. After the ramp it has to
/// discharge, by a speed beyond the request. The closed loop of the drive, with T = inertia/proportional gain and its
/// integral time Tᵢ,
///
///   q̇/q̇* = (1 + Tᵢ s)/(1 + Tᵢ s + T Tᵢ s²)
///
/// has a zero at −1/Tᵢ. The speed follows the plan without an overshoot for
///
///   q̇* = plan + T·(a − ā),   Tᵢ·dā/dt = a − ā
///
/// Tᵢ is taken as 4 T, that of a critically damped loop. A drive that is twice as slow as T overshoots half as much as
/// without the lead; one that is faster comes from below.
///
/// All in all the lead drives no way. A stop ends where the plan ends, if the lead is ordered until it has `ended`.

#include <cmath>

namespace robot_control {

class SpeedLead {
 public:
  /// `response_time` is T in s; 0: the order is the plan. `period` is in s.
  SpeedLead(double response_time, double period) noexcept : time_(response_time), period_(period) {}

  void reset() noexcept { slow_ = 0; }

  /// Returns true where the order is the plan until the plan accelerates.
  bool ended() const noexcept { return slow_ == 0; }

  /// Returns q̇* in rad/s, `periods` after the last step, for a planned speed in rad/s with its acceleration in rad/s².
  double step(double plan, double acceleration, double periods) noexcept {
    if (time_ == 0) return plan;
    slow_ += (1 - std::exp(-periods * period_ / (4 * time_))) * (acceleration - slow_);
    if (acceleration == 0 && std::abs(time_ * slow_) < kNone) slow_ = 0;
    return plan + time_ * (acceleration - slow_);
  }

 private:
  static constexpr double kNone = 1.0e-3;  // rad/s: a wheel at rest is ordered to rest

  double time_;
  double period_;
  double slow_ = 0;  // ā, rad/s²
};

}  // namespace robot_control
