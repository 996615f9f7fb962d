#pragma once
/// Small algebra of rotations that the filter's files share; frames' plain values to Eigen's and back.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "signals/geometry.h"
#include "signals/rotation.h"

namespace robot_control::algebra {

inline double square(double value) noexcept {
  return value * value;
}

/// [v]×: cross_matrix(v) · w = v × w.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) noexcept {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Exp([angle]×), Rodrigues' formula, by its series where the angle is small. rad
inline Eigen::Matrix3d exponential(const Eigen::Vector3d& angle) noexcept {
  const double squared = angle.squaredNorm();
  const double norm = std::sqrt(squared);
  const double a = squared < 1e-6 ? 1 - squared / 6 : std::sin(norm) / norm;
  const double b = squared < 1e-6 ? 0.5 - squared / 24 : (1 - std::cos(norm)) / squared;
  const Eigen::Matrix3d x = cross_matrix(angle);
  return Eigen::Matrix3d::Identity() + a * x + b * (x * x);
}

/// One step of Newton's iteration for the polar decomposition keeps a rotation a rotation.
inline void orthonormalise(Eigen::Matrix3d& r) noexcept {
  const Eigen::Matrix3d excess = r.transpose() * r - Eigen::Matrix3d::Identity();
  r -= 0.5 * r * excess;
}

inline Eigen::Matrix3d about_z(double yaw) noexcept {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

inline double yaw_of(const Eigen::Matrix3d& r) noexcept {
  return std::atan2(r(1, 0), r(0, 0));
}

inline double yaw_of(const Quaternion& q) noexcept {
  return std::atan2(2 * (q[3] * q[2] + q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
}

/// ∂yaw/∂θ of an error θ about the outer axes, for θ_x and θ_y; that for θ_z is 1.
/// With h = R e_x: −h_z (h_x, h_y) / (h_x² + h_y²). Bounded where the robot stands on its nose.
inline Eigen::Vector2d yaw_by_tilt(const Eigen::Matrix3d& r) noexcept {
  constexpr double kUpright = 1e-6;
  const Eigen::Vector3d h = r.col(0);
  return -h.z() / std::max(h.x() * h.x() + h.y() * h.y(), kUpright) * h.head<2>();
}

inline Eigen::Vector3d vector(const Vector3& v) noexcept {
  return {v[0], v[1], v[2]};
}

inline Vector3 array(const Eigen::Vector3d& v) noexcept {
  return {v.x(), v.y(), v.z()};
}

inline Quaternion quaternion_of(const Eigen::Matrix3d& r) noexcept {
  const Eigen::Quaterniond q(r);
  return {q.x(), q.y(), q.z(), q.w()};
}

}  // namespace robot_control::algebra
