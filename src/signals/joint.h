#pragma once
/// JointSample holds the measured values of one joint, JointCommand the command to it.

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace robot_control {

inline constexpr std::size_t kMaxJoints = 32;

struct JointSample {
  double position = 0;     ///< rad or m, at t_k
  double velocity = 0;     ///< rad/s or m/s, at t_k
  double effort = 0;       ///< N·m or N, the mean actually applied over [t_k-1, t_k)
  double temperature = 0;  ///< °C; 0 where the drive has no sensor
};

enum class JointMode : std::uint64_t {
  kBrake = 0,      ///< The driver's own law damps the velocity and, below a small speed, holds the position.
  kEffort = 1,     ///< τ = effort
  kVelocity = 2,   ///< τ = effort + damping · (velocity − q̇)
  kImpedance = 3,  ///< τ = effort + stiffness · (position − q) + damping · (velocity − q̇)
};

/// Gate and driver clamp the resulting effort to the joint's limit. Fields that a mode does not use are also filled in:
/// in kEffort, `velocity` is the wheel loop's target, for display.
struct JointCommand {
  JointMode mode = JointMode::kBrake;
  double position = 0;   ///< rad or m
  double velocity = 0;   ///< rad/s or m/s
  double stiffness = 0;  ///< N·m/rad or N/m
  double damping = 0;    ///< N·m·s/rad or N·s/m
  double effort = 0;     ///< N·m or N
};

/// Returns whether every number is finite, also those that the mode does not use.
inline bool finite(const JointCommand& joint) noexcept {
  return std::isfinite(joint.position) && std::isfinite(joint.velocity) && std::isfinite(joint.stiffness) &&
         std::isfinite(joint.damping) && std::isfinite(joint.effort);
}

}  // namespace robot_control
