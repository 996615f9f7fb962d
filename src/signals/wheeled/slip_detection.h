#pragma once
/// slip_detection describes in words how WheeledState::residual_level affects the detection of slip.
///
/// With an IMU such as the BMI088, slip above 0.04 m/s times the level is detected within 0.4 s
/// (estimation/wheeled/slip/slip_watch.h). From kSlowDetection on this is 0.12 m/s, from kNoDetection on 1.6 m/s.

#include "signals/formatted_text.h"

namespace robot_control {

inline constexpr double kSlowDetection = 3;
inline constexpr double kNoDetection = 40;

/// Returns "on", "slow: residuals 12 × the sensors' noise", "off: …" or "unknown: nothing was compared yet".
inline std::string slip_detection(double residual_level) {
  if (residual_level == 0) return "unknown: nothing was compared yet";
  if (residual_level < kSlowDetection) return "on";
  return formatted("%s: residuals %.0f × the sensors' noise", residual_level < kNoDetection ? "slow" : "off",
                   residual_level);
}

}  // namespace robot_control
