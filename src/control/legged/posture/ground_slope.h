#pragma once
/// The slope of the ground below a robot that lies, from its attitude.
///
/// The axes of the ground are those of a body that stands on it in its nominal pose. A body that lies leans to them by
/// LegModel::lying_pitch. The slope is the angle from their z axis to the vertical.
///
/// A robot stands up where the slope is at most kMaxSlope. There each foot needs half of its grip on ground of friction
/// 0.5, as at most in body_bounds.h. A slope below kLevelSlope counts as level, because an accelerometer errs so much.

#include <Eigen/Geometry>

#include "signals/rotation.h"

namespace robot_control {

inline constexpr double kMaxSlope = 0.25;    ///< rad
inline constexpr double kLevelSlope = 0.06;  ///< rad

/// Returns the vertical, upwards, in the axes of the ground.
inline Eigen::Vector3d vertical_over_ground(const Quaternion& attitude, double lying_pitch) noexcept {
  return Eigen::AngleAxisd(lying_pitch, Eigen::Vector3d::UnitY()) * rotation_of(attitude).row(2).transpose();
}

}  // namespace robot_control
