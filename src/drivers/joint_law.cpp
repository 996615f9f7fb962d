#include "drivers/joint_law.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

Brake within(double effort_limit, Brake brake) {
  brake.effort = std::min(brake.effort, effort_limit);
  brake.hold_effort = std::min(brake.hold_effort, effort_limit);
  return brake;
}

}  // namespace

JointLaw::JointLaw(const Brake& brake, double effort_limit)
    : brake_(within(effort_limit, brake)), effort_limit_(effort_limit) {}

void JointLaw::reset() noexcept {
  applied_ = 0;
  brake_.release();
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
      return applied_ = brake_.step(applied_, position, velocity);
  }
  if (!std::isfinite(effort)) return applied_ = brake_.step(applied_, position, velocity);
  brake_.release();
  return applied_ = std::clamp(effort, -effort_limit_, effort_limit_);
}

}  // namespace robot_control
