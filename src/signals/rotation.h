#pragma once
/// These functions convert a quaternion to a rotation matrix, or to roll, pitch and yaw.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "signals/geometry.h"

namespace robot_control {

/// Cosine and sine of an angle in rad, with which several vectors are turned.
struct Turn {
  Turn(double angle) noexcept : cos(std::cos(angle)), sin(std::sin(angle)) {}

  double cos, sin;
};

/// Returns the matrix that converts vectors from the rotated axes to the axes to which `q` refers. `q` is x y z w with
/// any length except 0.
inline Eigen::Matrix3d rotation_of(const Quaternion& q) noexcept {
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
}

/// Return the angle in rad of a unit quaternion: roll about x, then pitch about y, then yaw about z (REP 103).
inline double roll_of(const Quaternion& q) noexcept {
  const auto [x, y, z, w] = q;
  return std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y));
}

inline double pitch_of(const Quaternion& q) noexcept {
  const auto [x, y, z, w] = q;
  return std::asin(std::clamp(2 * (w * y - z * x), -1.0, 1.0));
}

inline double yaw_of(const Quaternion& q) noexcept {
  const auto [x, y, z, w] = q;
  return std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

}  // namespace robot_control
