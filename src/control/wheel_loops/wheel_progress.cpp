#include "control/wheel_loops/wheel_progress.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

constexpr double kTime = 0.03;  // s

}  // namespace

void WheelProgress::restart_from(double angle) noexcept {
  angle_ = angle;
  planned_ = speed_ = held_ = 0;
}

void WheelProgress::step(double planned, double angle, double quantum, double dt) noexcept {
  const double turned = angle - angle_;
  angle_ = angle;
  held_ = 0;
  if (planned * planned_ <= 0) {
    planned_ = speed_ = planned;
    return;
  }
  const double time = std::max(kTime, quantum / (kTurns * std::abs(planned)));
  const double part = dt / (time + dt);
  planned_ += part * (planned - planned_);
  speed_ += part * (turned / dt - speed_);
  held_ = std::copysign(std::clamp(1 - speed_ / (kTurns * planned_), 0.0, 1.0), planned_);
}

}  // namespace robot_control
