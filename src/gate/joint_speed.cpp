#include "gate/joint_speed.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

JointSpeed::JointSpeed(double period) noexcept
    : period_(period),
      base_(static_cast<std::uint64_t>(std::clamp(std::ceil(kSpeedBase / period), 2.0, kChanges - 2.0))) {}

void JointSpeed::step(double position, std::uint64_t cycle) noexcept {
  if (count_ == 0 || position != change(count_ - 1).position) {
    changes_[count_ % kChanges] = {cycle, position};
    ++count_;
    while (first_ + 1 < count_ && cycle - change(first_ + 1).cycle >= base_) ++first_;
  }
  const Change& a = change(count_ - 1);
  const Change& b = change(first_);
  const std::uint64_t cycles = std::max({a.cycle - b.cycle, cycle - a.cycle, base_});
  speed_ = (a.position - b.position) / (static_cast<double>(cycles) * period_);
}

}  // namespace robot_control
