#include "control/common/limits/stop_distance.h"

#include <cmath>

namespace robot_control {

double stop_distance(double speed, double deceleration, double jerk) noexcept {
  const double v = std::abs(speed);
  if (v < deceleration * deceleration / jerk) return v * std::sqrt(v / jerk);
  return 0.5 * v * (v / deceleration + deceleration / jerk);
}

}  // namespace robot_control
