#include "safety/measurements/slide.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control {

Slide::Slide(const SafetyParameters& parameters, const DriveTrain& robot, double period) noexcept
    : period_(period),
      deceleration_(parameters.stop_deceleration),
      limit_(parameters.wheel_speed.limit.value_or(std::numeric_limits<double>::infinity())) {
  double largest = 0;
  for (std::size_t i = 0; i < std::min(robot.wheels.size(), kMaxWheels); ++i) {
    radius_[i] = robot.wheels[i].radius;
    largest = std::max(largest, radius_[i]);
  }
  limit_ *= largest;
}

double Slide::fastest_rim(const WheelMotion& motion) const noexcept {
  double fastest = 0;
  for (std::size_t i = 0; i < motion.wheels(); ++i) {
    fastest = std::max(fastest, std::abs(motion.speed(i)) * radius_[i]);
  }
  return fastest;
}

void Slide::step(const WheelMotion& motion, bool standing, std::uint64_t elapsed) noexcept {
  if (!motion.speed_known()) return;
  const double dt = static_cast<double>(elapsed) * period_;
  const double rim = standing ? 0 : fastest_rim(motion);
  const double lost = std::max(0.0, speed_ - deceleration_ * dt);
  speed_ = std::max(lost, std::min({rim, speed_ + kGrip * dt, limit_}));
}

}  // namespace robot_control
