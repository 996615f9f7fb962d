#include "safety/measurements/joint_standstill.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

JointStandstill::JointStandstill(double standstill_speed, double period) noexcept
    : window_(standstill_speed * kStandingTime),
      cycles_(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(kStandingTime / period)))) {}

void JointStandstill::enter_run() noexcept {
  anchored_ = moving_ = standing_ = false;
}

void JointStandstill::step(const WheelMotion& motion, std::uint64_t cycle) noexcept {
  if (!motion.sampled()) {
    anchored_ = standing_ = false;
    moving_ = true;
    return;
  }
  if (!anchored_) return begin_window(motion, cycle);
  if (!inside(motion)) {
    moving_ = true;
    standing_ = false;
    return begin_window(motion, cycle);
  }
  if (cycle - since_ < cycles_) return;
  moving_ = false;
  standing_ = true;
  begin_window(motion, cycle);
}

bool JointStandstill::inside(const WheelMotion& motion) const noexcept {
  bool inside = true;
  for (std::size_t i = 0; i < motion.wheels(); ++i) {
    const double window = std::max(window_, 1.5 * motion.quantum(i)) * (standing_ ? 2 : 1);
    inside = inside && std::abs(motion.angle(i) - anchor_[i]) < window;
  }
  return inside;
}

void JointStandstill::begin_window(const WheelMotion& motion, std::uint64_t cycle) noexcept {
  for (std::size_t i = 0; i < motion.wheels(); ++i) anchor_[i] = motion.angle(i);
  since_ = cycle;
  anchored_ = true;
}

}  // namespace robot_control
