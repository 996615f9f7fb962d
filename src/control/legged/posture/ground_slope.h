#pragma once
/// The slope of the ground below a robot that lies, from its attitude.
///
/// The axes of the ground are those of a body that stands on it in its nominal pose. A body that lies leans to them by
/// LegModel::lying_pitch. The slope is the angle from their z axis to the vertical.
///
/// A robot stands up where the slope is at most kMaxSlope. A foot that stands there needs friction 0.4, and with
/// kSlopeGrip, which balance and swinging legs need beside the weight, 0.6. A slope below kLevelSlope counts as level,
/// because an accelerometer errs so much.

#include <Eigen/Geometry>

#include "signals/rotation.h"

namespace robot_control {

inline constexpr double kMaxSlope = 0.42;    ///< rad
inline constexpr double kLevelSlope = 0.06;  ///< rad

inline constexpr double kSlopeGrip = 1.5;  ///< of the tangent of the slope

/// Returns the rotation from the axes of a ground with these slopes to the front and left into level axes. Its x axis
/// shows ahead.
inline Eigen::Matrix3d ground_axes(double ahead, double left) noexcept {
  Eigen::Matrix3d axes;
  axes.col(2) = Eigen::Vector3d(-ahead, -left, 1).normalized();
  axes.col(0) = Eigen::Vector3d(1, 0, ahead).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

/// Returns the vertical, upwards, in the axes of the ground.
inline Eigen::Vector3d vertical_over_ground(const Quaternion& attitude, double lying_pitch) noexcept {
  return Eigen::AngleAxisd(lying_pitch, Eigen::Vector3d::UnitY()) * rotation_of(attitude).row(2).transpose();
}

}  // namespace robot_control
