#pragma once
/// The largest speed from which the robot can stop within the free distance ahead.
///
///   v·t + v²/(2a) ≤ c   ⇒   v = a·(√(t² + 2c/a) − t) = 2c/(t + √(t² + 2c/a))
///
/// c the clearance (m), t stop_delay (s), during which the robot drives on, a stop_deceleration (m/s²). The second form
/// has no cancellation for a small c. c = ∞ means unlimited; c ≤ 0 and NaN give speed 0.
///
/// c is the parameter `clearance` (0: unlimited) until the first message on the topic, then the topic's last value. The
/// node sets it to 0 when a stream falls silent (ros/inputs/clearance_stream.h).

#include <cmath>

#include "safety/safety_parameters.h"
#include "signals/permit.h"
#include "signals/velocity_command.h"

namespace robot_control {

class Clearance {
 public:
  /// `period` s.
  Clearance(const SafetyParameters& parameters, double period) noexcept
      : delay_(parameters.stop_delay.value_or(default_stop_delay(period))),
        deceleration_(parameters.stop_deceleration),
        from_parameter_(parameters.clearance > 0 ? speed(parameters.clearance) : kNoSpeedLimit) {}

  /// m/s
  double speed_limit(const OperatorInput& operator_input) const noexcept {
    return operator_input.clearances > 0 ? speed(operator_input.clearance) : from_parameter_;
  }

 private:
  double speed(double clearance) const noexcept {
    if (!(clearance > 0)) return 0;
    if (clearance >= kNoSpeedLimit) return kNoSpeedLimit;
    return 2 * clearance / (delay_ + std::sqrt(delay_ * delay_ + 2 * clearance / deceleration_));
  }

  double delay_;
  double deceleration_;
  double from_parameter_;
};

}  // namespace robot_control
