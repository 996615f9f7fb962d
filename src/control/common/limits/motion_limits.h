#pragma once
/// Limits of the motion along one axis of a robot on wheels or legs. Two of them are derived where the user gives none:
///
///   emergency deceleration  f·deceleration, with f = 2, less if that exceeds kHalfGrip, but at least 1
///   jerk                    max(acceleration, emergency deceleration / 2) / 0.1 s

#include <limits>
#include <optional>

namespace robot_control {

/// Holds the limits of one axis in m/s or rad/s and their derivatives, all > 0.
struct MotionLimits {
  double speed = 1.0;
  double acceleration = 1.0;
  double deceleration = 1.0;
  double emergency_deceleration = 1.0;                    ///< ≥ deceleration
  double jerk = std::numeric_limits<double>::infinity();  ///< infinity: none
  std::optional<double> reverse_speed = {};               ///< ≥ 0, limit of speeds below 0; absent: as forwards
  std::optional<double> reverse_acceleration = {};
  std::optional<double> reverse_deceleration = {};

  /// Returns the limits in a direction; 0 counts as forwards.
  double speed_towards(double direction) const noexcept {
    return direction < 0 ? reverse_speed.value_or(speed) : speed;
  }
  double acceleration_towards(double direction) const noexcept {
    return direction < 0 ? reverse_acceleration.value_or(acceleration) : acceleration;
  }
  double deceleration_from(double direction) const noexcept {
    return direction < 0 ? reverse_deceleration.value_or(deceleration) : deceleration;
  }
};

/// This is half of what dry ground of friction 1 carries, in m/s².
inline constexpr double kHalfGrip = 4.9;

/// Returns m/s² ≥ `deceleration`, which is > 0.
double derived_emergency_deceleration(double deceleration) noexcept;

/// Returns m/s³ or rad/s³, > 0, from two values > 0 in m/s² or rad/s².
double derived_jerk(double acceleration, double emergency_deceleration) noexcept;

}  // namespace robot_control
