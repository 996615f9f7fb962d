#pragma once
/// Which way is up, in base axes: gravity's direction turned by the gyro, and pulled towards what the accelerometer
/// says beyond the wheels' acceleration. Bounded: the robot stands on its wheels.
///
///   u̇ = −ω × u + e / (g kTime)       e: m/s², by which gravity seems to be wrong
///
/// The gyro's x and y count after a first rest only, when their bias is known: a broken axis reads −31 °/s at rest.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "signals/geometry.h"

namespace robot_control {

class Tilt {
 public:
  static constexpr double kGravity = 9.80665;  ///< m/s²
  static constexpr double kTime = 3.0;         ///< s, in which a wrong tilt is forgotten while driving
  static constexpr double kSteepest = 0.6;     ///< sine of the tilt: 37°, where rubber on dry ground begins to slide

  void reset() noexcept { up_ = {0, 0, 1}; }

  /// rad/s, bias removed.
  void turn(const Vector3& rate, double dt) noexcept {
    const Eigen::Vector3d u(up_.data());
    set(u - dt * Eigen::Vector3d(rate[0], rate[1], rate[2]).cross(u));
  }

  /// m/s², along and across.
  void pull(double along, double across, double dt) noexcept {
    const double gain = std::min(1.0, dt / kTime) / kGravity;
    set(Eigen::Vector3d(up_[0] + gain * along, up_[1] + gain * across, up_[2]));
  }

  /// The robot rests: `force` m/s² is its accelerometer's mean over `dt`, `time` s since the rest began.
  void rest(const Vector3& force, double dt, double time) noexcept {
    const Eigen::Vector3d f(force.data());
    if (!(f.norm() > kGravity / 2 && f.norm() < 2 * kGravity)) return;
    const Eigen::Vector3d u(up_.data());
    set(u + std::min(1.0, dt / std::max(dt, std::min(time, kTime))) * (f.normalized() - u));
  }

  const Vector3& up() const noexcept { return up_; }
  double roll() const noexcept { return std::atan2(up_[1], up_[2]); }                  ///< rad
  double pitch() const noexcept { return std::asin(std::clamp(-up_[0], -1.0, 1.0)); }  ///< rad

 private:
  void set(const Eigen::Vector3d& up) noexcept {
    const double norm = up.norm();
    if (!(norm > 0.1)) return;
    Eigen::Vector3d u = up / norm;
    const double flat = u.head<2>().norm();
    if (flat > kSteepest || u.z() < 0) {
      u.head<2>() *= kSteepest / std::max(flat, kSteepest);
      u.z() = std::sqrt(1 - u.head<2>().squaredNorm());
    }
    up_ = {u.x(), u.y(), u.z()};
  }

  Vector3 up_{0, 0, 1};
};

}  // namespace robot_control
