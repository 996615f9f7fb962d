#pragma once
/// Quaternions of attitudes and of small turns.

#include <Eigen/Geometry>
#include <array>

namespace robot_control {

/// `q` is x y z w.
inline Eigen::Quaterniond quaternion_of(const std::array<double, 4>& q) noexcept {
  return {q[3], q[0], q[1], q[2]};
}

inline void store(const Eigen::Quaterniond& q, std::array<double, 4>& to) noexcept {
  const Eigen::Quaterniond unit = q.normalized();
  to = {unit.x(), unit.y(), unit.z(), unit.w()};
}

/// Returns the turn by a small angle in rad.
inline Eigen::Quaterniond turned_by(const Eigen::Vector3d& angle) noexcept {
  return Eigen::Quaterniond(1, angle.x() / 2, angle.y() / 2, angle.z() / 2).normalized();
}

}  // namespace robot_control
