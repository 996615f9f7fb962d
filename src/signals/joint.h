#pragma once
/// One joint: what is measured of it and what can be asked of it.

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
  kBrake = 0,      ///< The driver's own law: velocity damping, below a small speed position hold.
  kEffort = 1,     ///< τ = effort
  kVelocity = 2,   ///< τ = effort + damping · (velocity − q̇)
  kImpedance = 3,  ///< τ = effort + stiffness · (position − q) + damping · (velocity − q̇)
};

/// Clamped to the joint's effort limit by the gate and by the driver. The fields that a mode does not
/// use are carried all the same (in kEffort, `velocity` is the wheel loop's target, for display).
struct JointCommand {
  JointMode mode = JointMode::kBrake;
  double position = 0;   ///< rad or m
  double velocity = 0;   ///< rad/s or m/s
  double stiffness = 0;  ///< N·m/rad or N/m
  double damping = 0;    ///< N·m·s/rad or N·s/m
  double effort = 0;     ///< N·m or N
};

/// Every number of it, used by its mode or not.
inline bool finite(const JointCommand& joint) noexcept {
  return std::isfinite(joint.position) && std::isfinite(joint.velocity) && std::isfinite(joint.stiffness) &&
         std::isfinite(joint.damping) && std::isfinite(joint.effort);
}

}  // namespace robot_control
