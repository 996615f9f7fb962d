#pragma once
/// The commands of drives that close the loops of their own speeds (`takes_speeds`, from robot.wheel_command).

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "drivers/joint_law.h"
#include "signals/joint.h"

namespace robot_control {

/// Returns whether a driver carries out this mode with drives that take speeds, or else torques.
inline bool accepted(JointMode mode, bool takes_speeds) noexcept {
  if (takes_speeds) return mode == JointMode::kBrake || mode == JointMode::kDriveVelocity;
  return JointLaw::computes(mode);
}

/// Returns the speed of the joint in rad/s: 0 for every mode but kDriveVelocity and for numbers that are not finite.
/// The drive thus brakes with its own loop, and at rest keeps the speed zero.
inline double wanted_speed(const JointCommand& command, double velocity_limit) noexcept {
  if (command.mode != JointMode::kDriveVelocity || !finite(command)) return 0;
  return std::clamp(command.velocity, -velocity_limit, velocity_limit);
}

/// Returns the whole number of a message, within ±2·10⁹.
inline std::int32_t rounded(double value) noexcept {
  return static_cast<std::int32_t>(std::clamp(std::round(value), -2.0e9, 2.0e9));
}

}  // namespace robot_control
