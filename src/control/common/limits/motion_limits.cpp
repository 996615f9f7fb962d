#include "control/common/limits/motion_limits.h"

#include <algorithm>

namespace robot_control {
namespace {

constexpr double kBuildUpTime = 0.1;  // s

}  // namespace

double derived_emergency_deceleration(double deceleration) noexcept {
  return std::max(deceleration, std::min(2 * deceleration, kHalfGrip));
}

double derived_jerk(double acceleration, double emergency_deceleration) noexcept {
  return std::max(acceleration, emergency_deceleration / 2) / kBuildUpTime;
}

}  // namespace robot_control
