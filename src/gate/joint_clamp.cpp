#include "gate/joint_clamp.h"

#include <algorithm>
#include <cmath>

#include "signals/gate_report.h"

namespace robot_control {
namespace {

bool has_damping(const JointCommand& command) noexcept {
  return command.mode == JointMode::kVelocity || command.mode == JointMode::kImpedance;
}

bool has_velocity(const JointCommand& command) noexcept {
  return has_damping(command) || command.mode == JointMode::kDriveVelocity;
}

/// True: `value` was more than `bound` in the direction ±1.
bool bound_towards(double direction, double bound, double& value) noexcept {
  if (direction * value <= bound) return false;
  value = direction * bound;
  return true;
}

bool drop_if_negative(double& gain) noexcept {
  if (gain >= 0) return false;
  gain = 0;
  return true;
}

}  // namespace

std::uint64_t clamp_effort(const JointLimits& limits, JointCommand& command) noexcept {
  if (std::abs(command.effort) <= limits.effort) return 0;
  command.effort = std::copysign(limits.effort, command.effort);
  return kGateEffortClamped;
}

std::uint64_t clamp_gains(JointCommand& command) noexcept {
  bool clamped = has_damping(command) && drop_if_negative(command.damping);
  if (command.mode == JointMode::kImpedance) clamped |= drop_if_negative(command.stiffness);
  return clamped ? std::uint64_t{kGateSpeedClamped} : 0;
}

std::uint64_t clamp_rate(double low, double high, JointCommand& command) noexcept {
  if (command.effort >= low && command.effort <= high) return 0;
  command.effort = command.effort < low ? low : high;
  return kGateRateClamped;
}

std::uint64_t clamp_acceleration(double low, double high, JointCommand& command) noexcept {
  if (command.mode != JointMode::kDriveVelocity) return 0;
  if (command.velocity >= low && command.velocity <= high) return 0;
  command.velocity = command.velocity < low ? low : high;
  return kGateRateClamped;
}

std::uint64_t clamp_speed(const JointLimits& limits, double position, double speed, JointCommand& command) noexcept {
  bool clamped = false;
  if (has_velocity(command)) {
    clamped =
        bound_towards(1, limits.velocity, command.velocity) || bound_towards(-1, limits.velocity, command.velocity);
  }
  const double part = std::abs(speed) / limits.velocity;
  if (part > kTaperStart) {
    const double direction = std::copysign(1.0, speed);
    const double taper = std::max(0.0, (1 - part) / (1 - kTaperStart));
    clamped |= bound_towards(direction, taper * limits.effort, command.effort);
    if (command.mode == JointMode::kImpedance && direction * (command.position - position) > 0) {
      command.stiffness *= taper;
      clamped = true;
    }
  }
  return clamped ? std::uint64_t{kGateSpeedClamped} : 0;
}

std::uint64_t clamp_position(const JointLimits& limits, double position, JointCommand& command) noexcept {
  bool clamped = false;
  if (command.mode == JointMode::kImpedance) {
    const double inside = std::clamp(command.position, limits.lower, limits.upper);
    clamped = inside != command.position;
    command.position = inside;
  }
  for (const double direction : {1.0, -1.0}) {
    const double left = direction > 0 ? limits.upper - position : position - limits.lower;
    if (left > limits.soft_zone) continue;
    const bool moves = has_velocity(command) && direction * command.velocity > 0;
    if (left <= 0) {
      if (!moves && direction * command.effort <= 0) continue;
      command = {};
      return kGatePositionClamped;
    }
    const double taper = left / limits.soft_zone;
    const double fastest = std::isfinite(limits.velocity) ? limits.velocity : std::abs(command.velocity);
    clamped |= bound_towards(direction, taper * limits.effort, command.effort);
    if (has_velocity(command)) clamped |= bound_towards(direction, taper * fastest, command.velocity);
  }
  return clamped ? std::uint64_t{kGatePositionClamped} : 0;
}

}  // namespace robot_control
