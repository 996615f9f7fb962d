#pragma once
/// A direction that is fixed in the world, in base axes: the gyro carries it, measurements pull it. It begins as z.
///
///   prediction  ḋ = −ω × d
///   correction  d ← d + w (m − d), of unit length; m a measured direction, w its weight 0 … 1

#include <Eigen/Geometry>
#include <cmath>

#include "machine/stored.h"

namespace robot_control {

/// Returns the rotation that brings what the world keeps into the axes of a body that has turned with `rate` rad/s for
/// `dt` s. A turn that is not finite counts as none.
inline Eigen::Matrix3d turned_back(const Eigen::Vector3d& rate, double dt) noexcept {
  const double size = rate.norm();
  const double angle = size * dt;
  if (!(angle > 0 && std::isfinite(angle))) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(-angle, rate / size).toRotationMatrix();
}

class FixedDirection {
 public:
  /// `back` is turned_back() of the body's turn.
  void turn(const Eigen::Matrix3d& back) noexcept { set(back * vector()); }

  /// `measured` is of unit length.
  void pull(const Eigen::Vector3d& measured, double weight) noexcept {
    const Eigen::Vector3d pulled = vector() + weight * (measured - vector());
    const double length = pulled.norm();
    set(length > 0.5 ? Eigen::Vector3d(pulled / length) : measured);
  }

  Eigen::Vector3d vector() const noexcept { return *direction_; }

  /// rad, 0 … π, between the direction and the base's z axis.
  double tilt() const noexcept { return std::atan2(across_, (*direction_).z()); }

  /// Returns true only if `tilt` does not exceed `angle`, rad: no angle exceeds its tangent.
  bool surely_within(double angle) const noexcept { return across_ < angle * (*direction_).z(); }

  /// rad/s, the derivative of `tilt` while the body turns at `rate`: (ω_x d_y − ω_y d_x)/√(d_x² + d_y²); 0 upright.
  double tilt_rate(const Eigen::Vector3d& rate) const noexcept {
    constexpr double kUpright = 1e-9;  // rad; below it no direction of tilting is known
    return across_ > kUpright ? (rate.x() * (*direction_).y() - rate.y() * (*direction_).x()) / across_ : 0;
  }

 private:
  void set(const Eigen::Vector3d& direction) noexcept {
    direction_ = Stored<Eigen::Vector3d>(direction);
    across_ = std::hypot(direction.x(), direction.y());
  }

  Stored<Eigen::Vector3d> direction_{Eigen::Vector3d::UnitZ()};
  double across_ = 0;  ///< length of its part across the base's z axis
};

}  // namespace robot_control
