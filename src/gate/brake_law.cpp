#include "gate/brake_law.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

constexpr int kMarkSteps = 50;

double bounded(double value, double bound) noexcept {
  return std::clamp(value, -bound, bound);
}

}  // namespace

double BrakeLaw::step(double applied, double position, double velocity) noexcept {
  const double speed = std::abs(velocity);
  if (!braking_) {
    braking_ = true;
    steps_since_mark_ = 0;
    marked_speed_ = speed;
  }
  if (!holding_ && (speed <= brake_.hold_speed || speed_stays(speed))) {
    holding_ = true;
    reference_ = position + (bounded(applied, brake_.hold_effort) + brake_.damping * velocity) / brake_.stiffness;
  }
  if (!holding_) return bounded(-brake_.damping * velocity, brake_.effort);

  const double wanted = brake_.stiffness * (reference_ - position) - brake_.damping * velocity;
  const double effort = bounded(wanted, brake_.hold_effort);
  if (effort != wanted) reference_ = position + (effort + brake_.damping * velocity) / brake_.stiffness;
  return effort;
}

bool BrakeLaw::speed_stays(double speed) noexcept {
  if (++steps_since_mark_ < kMarkSteps) return false;
  const bool saturated = brake_.damping * speed >= brake_.effort;
  const bool stays = speed > (saturated ? 1.0 : 0.9) * marked_speed_;
  steps_since_mark_ = 0;
  marked_speed_ = speed;
  return stays;
}

}  // namespace robot_control
