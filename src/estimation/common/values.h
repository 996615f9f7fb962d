#pragma once
/// These functions compute with plain values, of which the estimator's state consists.

#include <Eigen/Core>
#include <cmath>

#include "machine/stored.h"
#include "signals/geometry.h"
#include "signals/rotation.h"

namespace robot_control {

inline double square(double value) noexcept {
  return value * value;
}
inline Vector3 array(const Eigen::Vector3d& v) noexcept {
  return {v.x(), v.y(), v.z()};
}
inline Eigen::Vector3d vector(const Vector3& v) noexcept {
  return {v[0], v[1], v[2]};
}

/// This vector in the plane is trivially copyable, which Eigen's vectors are not.
struct Planar {
  double x = 0, y = 0;

  friend Planar operator+(const Planar& a, const Planar& b) noexcept { return {a.x + b.x, a.y + b.y}; }
  friend Planar operator-(const Planar& a, const Planar& b) noexcept { return {a.x - b.x, a.y - b.y}; }
  friend Planar operator-(const Planar& a) noexcept { return {-a.x, -a.y}; }
  friend Planar operator*(const Planar& a, double factor) noexcept { return {a.x * factor, a.y * factor}; }
  friend Planar operator/(const Planar& a, double divisor) noexcept { return {a.x / divisor, a.y / divisor}; }
  double norm() const noexcept { return std::hypot(x, y); }
};

/// Returns `v` turned. If the turn is that by the yaw, this changes base axes to odom axes.
inline Planar rotated(const Planar& v, const Turn& turn) noexcept {
  return {turn.cos * v.x - turn.sin * v.y, turn.sin * v.x + turn.cos * v.y};
}

}  // namespace robot_control
