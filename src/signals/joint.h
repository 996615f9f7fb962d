#pragma once
/// JointSample holds the measured values of one joint, JointCommand the command to it.

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace robot_control {

inline constexpr std::size_t kMaxJoints = 32;

/// Bits of JointSample::valid: the numbers that the drive measured and that may be used, and what it takes.
enum JointValidity : std::uint32_t {
  kValidPosition = 1u << 0,
  kValidVelocity = 1u << 1,
  kValidEffort = 1u << 2,
  kValidTemperature = 1u << 3,
  kTakesEffort = 1u << 4,  ///< The drive adds the effort of a command in kDriveVelocity.
};

/// The bits of a drive with an encoder.
inline constexpr std::uint32_t kValidKinematics = kValidPosition | kValidVelocity;

/// The bits of a drive with an encoder and a measurement of its torque.
inline constexpr std::uint32_t kValidMotion = kValidPosition | kValidVelocity | kValidEffort;

/// A drive that sends no sample in a cycle leaves the last one in force, and its age grows. The driver moves the
/// position on with the velocity.
struct JointSample {
  double position = 0;  ///< rad or m, at t_k: at t_k − age, plus velocity · age
  double velocity = 0;  ///< rad/s or m/s, at t_k − age
  double effort = 0;  ///< N·m or N, the mean actually applied over one period before t_k − age; NaN: never measured
  double temperature = 0;   ///< °C
  std::int64_t age_ns = 0;  ///< time from the drive's sample to t_k
  std::uint32_t valid = 0;  ///< JointValidity bits
  std::uint32_t fault = 0;  ///< the drive's own fault word; 0: no fault
};

/// Returns whether all numbers that `bits` names may be used.
inline bool has(const JointSample& sample, std::uint32_t bits) noexcept {
  return (sample.valid & bits) == bits;
}

/// Returns whether the position may be used and is finite.
inline bool has_position(const JointSample& sample) noexcept {
  return has(sample, kValidPosition) && std::isfinite(sample.position);
}

/// Returns the velocity; 0 if it may not be used or is not finite.
inline double valid_velocity(const JointSample& sample) noexcept {
  return has(sample, kValidVelocity) && std::isfinite(sample.velocity) ? sample.velocity : 0;
}

enum class JointMode : std::uint64_t {
  kBrake = 0,      ///< The driver's own law damps the velocity and, below a small speed, holds the position.
  kEffort = 1,     ///< τ = effort
  kVelocity = 2,   ///< τ = effort + damping · (velocity − q̇)
  kImpedance = 3,  ///< τ = effort + stiffness · (position − q) + damping · (velocity − q̇)

  /// The drive itself closes the loop of its speed, with its own gains: q̇ → velocity. A drive that says
  /// kTakesEffort adds `effort`, any other one ignores it.
  kDriveVelocity = 4,
};

inline constexpr std::size_t kJointModes = 5;

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
