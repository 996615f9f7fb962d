#pragma once
/// Quaternion → rotation matrix; roll, pitch and yaw.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "signals/geometry.h"

namespace robot_control {

/// Turns vectors of the rotated axes into those of the axes that `q` refers to. `q`: x y z w, of any length but 0.
inline Eigen::Matrix3d rotation_of(const Quaternion& q) noexcept {
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
}

/// rad, of a unit quaternion: turned by roll about x, then by pitch about y, then by yaw about z (REP 103).
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
