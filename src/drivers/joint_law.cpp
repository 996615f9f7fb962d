#include "drivers/joint_law.h"

#include <algorithm>
#include <cmath>

#include "hal/driver.h"

namespace robot_control {
namespace {

constexpr int kMarkSteps = 50;

double clamped(double value, double limit) {
  return std::clamp(value, -limit, limit);
}

}  // namespace

JointLaw::JointLaw(const MujocoPlantParameters& parameters, double effort_limit)
    : damping_(parameters.brake_damping),
      stiffness_(parameters.brake_stiffness),
      hold_speed_(parameters.brake_hold_speed),
      brake_limit_(std::min(parameters.brake_effort, effort_limit)),
      effort_limit_(effort_limit) {}

void JointLaw::reset() noexcept {
  applied_ = 0;
  braking_ = holding_ = false;
}

double JointLaw::step(const JointCommand& command, double position, double velocity) noexcept {
  if (effort_limit_ <= 0) return 0;
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
  if (!holding_ && (speed <= hold_speed_ || speed_stays(speed))) {
    holding_ = true;
    reference_ = position + (clamped(applied_, brake_limit_) + damping_ * velocity) / stiffness_;
  }
  if (!holding_) return clamped(-damping_ * velocity, brake_limit_);

  const double wanted = stiffness_ * (reference_ - position) - damping_ * velocity;
  const double effort = clamped(wanted, brake_limit_);
  if (effort != wanted) reference_ = position + (effort + damping_ * velocity) / stiffness_;
  return effort;
}

bool JointLaw::speed_stays(double speed) noexcept {
  const bool saturated = damping_ * speed >= brake_limit_;
  if (!saturated && ++steps_since_mark_ < kMarkSteps) return false;
  const bool stays = !saturated && speed > 0.9 * marked_speed_;
  steps_since_mark_ = 0;
  marked_speed_ = speed;
  return stays;
}

void check_brake(const MujocoPlantParameters& parameters, const std::string& joint, double inertia, double step) {
  const auto check = [&](const std::string& name, double value, double limit, const std::string& unit) {
    if (value > 0 && value <= limit) return;
    throw DriverError("mujoco_plant/" + name + " = " + std::to_string(value) + " " + unit + ": joint " + joint +
                      " has an inertia of only " + std::to_string(inertia) + " kg·m², a time step of " +
                      std::to_string(step * 1000) + " ms bears values above 0 up to " + std::to_string(limit) + " " +
                      unit + ". Set such a value.");
  };
  check("brake_damping", parameters.brake_damping, 0.5 * inertia / step, "N·m·s/rad");
  check("brake_stiffness", parameters.brake_stiffness, 0.5 * inertia / (step * step), "N·m/rad");
}

}  // namespace robot_control
