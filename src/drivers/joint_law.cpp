#include "drivers/joint_law.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

constexpr int kMarkSteps = 50;

double clamped(double value, double limit) {
  return std::clamp(value, -limit, limit);
}

}  // namespace

JointLaw::JointLaw(const Brake& brake, double effort_limit) : brake_(brake), effort_limit_(effort_limit) {
  brake_.effort = std::min(brake.effort, effort_limit);
  brake_.hold_effort = std::min(brake.hold_effort, effort_limit);
}

void JointLaw::reset() noexcept {
  applied_ = 0;
  braking_ = holding_ = false;
}

double JointLaw::step(const JointCommand& command, double position, double velocity) noexcept {
  double effort = command.effort;
  switch (command.mode) {
    case JointMode::kEffort:
      break;
    case JointMode::kVelocity:
      effort += command.damping * (command.velocity - velocity);
      break;
    case JointMode::kImpedance:
      effort += command.stiffness * (command.position - position) + command.damping * (command.velocity - velocity);
      break;
    default:
      return applied_ = brake(position, velocity);
  }
  if (!std::isfinite(effort)) return applied_ = brake(position, velocity);
  braking_ = holding_ = false;
  return applied_ = clamped(effort, effort_limit_);
}

double JointLaw::brake(double position, double velocity) noexcept {
  const double speed = std::abs(velocity);
  if (!braking_) {
    braking_ = true;
    steps_since_mark_ = 0;
    marked_speed_ = speed;
  }
  if (!holding_ && (speed <= brake_.hold_speed || speed_stays(speed))) {
    holding_ = true;
    reference_ = position + (clamped(applied_, brake_.hold_effort) + brake_.damping * velocity) / brake_.stiffness;
  }
  if (!holding_) return clamped(-brake_.damping * velocity, brake_.effort);

  const double wanted = brake_.stiffness * (reference_ - position) - brake_.damping * velocity;
  const double effort = clamped(wanted, brake_.hold_effort);
  if (effort != wanted) reference_ = position + (effort + brake_.damping * velocity) / brake_.stiffness;
  return effort;
}

bool JointLaw::speed_stays(double speed) noexcept {
  if (++steps_since_mark_ < kMarkSteps) return false;
  const bool saturated = brake_.damping * speed >= brake_.effort;
  const bool stays = speed > (saturated ? 1.0 : 0.9) * marked_speed_;
  steps_since_mark_ = 0;
  marked_speed_ = speed;
  return stays;
}

}  // namespace robot_control
