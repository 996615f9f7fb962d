#pragma once
/// Estimates the direction of up in base axes and the accelerometer's bias along and across. The gyro turns the
/// direction. The accelerometer corrects it at rest, and in motion by its difference from the wheels' acceleration.
///
///   u̇ = −ω × u        accelerometer/g = u + β at rest        u: unit vector; β: bias/g, along and across
///
/// The error state is u_x, u_y, β_x, β_y. One rest shows only their sums. Rests in two headings separate them, because
/// gravity turns against the robot and the bias does not.
///
/// A rest may contradict the tilt that the gyro measured since the last one by more than kSignificant deviations. Then
/// the tilt is unknown. The bias keeps its variance, because a failing gyro does not change it. A correction in motion
/// that contradicts the tilt like that is not used, because any of the sensors may be wrong.
///
/// The tilt walks by kSlowAcceleration/g, 2 mrad, per √s. It is bounded by kSteepest, because the robot stands on its
/// wheels. The gyro's x and y count only after a first rest has shown their bias: a broken axis reads −31 °/s at rest.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "estimation/common/values.h"
#include "machine/gravity.h"
#include "signals/geometry.h"

namespace robot_control {

struct TiltParams {
  double accelerometer = 1.716e-3;  ///< m/s²/√Hz
  double bias = 0.2;                ///< m/s², standard deviation at switch-on
  double bias_walk = 6.5e-5;        ///< m/s²/√s
};

class Tilt {
 public:
  explicit Tilt(const TiltParams& params = {}) noexcept;

  void turn(const Vector3& rate, double dt) noexcept;  ///< rad/s, bias removed
  void age() noexcept;  ///< brings the variances to the present heading, as each correction does

  /// Corrects by the excess of gravity and bias over the values in use, along and across, in the last `dt`, in m/s².
  void correct(double along, double across, double dt, double deviation) noexcept;

  /// Corrects at rest: `force` (m/s²) is the accelerometer's mean over `dt`.
  void rest(const Vector3& force, double dt) noexcept;

  /// Continues an earlier process: `up` is in base axes, `bias` in m/s² along and across.
  void set(const Vector3& up, const std::array<double, 2>& bias) noexcept;

  Vector3 up() const noexcept { return array(*up_); }
  /// Returns the rotation by the roll about x, then the pitch about y, which turns base axes to axes with z up.
  Eigen::Quaterniond attitude() const noexcept;
  double bias(int axis) const noexcept { return kGravity * (*bias_)[axis]; }       ///< m/s², along and across
  double vertical_bias() const noexcept { return vertical_; }                      ///< m/s², along u
  double covariance(int i, int k) const noexcept { return (*covariance_)(i, k); }  ///< covariance of u_x, u_y
  /// Returns the variance of gravity and bias together, in (m/s²)².
  double acceleration_variance(int axis) const noexcept { return kGravity * kGravity * variance(axis); }
  /// Returns `force` without gravity and bias along and across, m/s².
  std::array<double, 2> acceleration(const Vector3& force) const noexcept {
    return {force[0] - kGravity * ((*up_)[0] + (*bias_)[0]), force[1] - kGravity * ((*up_)[1] + (*bias_)[1])};
  }

 private:
  using Covariance = Eigen::Matrix4d;

  void bound() noexcept;
  void open(const Eigen::Vector2d& off) noexcept;
  void update(const Eigen::Vector2d& sum, double noise) noexcept;
  bool contradicts(const Eigen::Vector2d& sum, double noise) const noexcept;
  Eigen::Vector2d innovation(const Eigen::Vector2d& sum) const noexcept;
  double variance(int axis) const noexcept;  ///< variance of u + β

  TiltParams params_;
  Stored<Eigen::Vector3d> up_{Eigen::Vector3d::UnitZ()};
  Stored<Eigen::Vector2d> bias_;   ///< β
  Stored<Covariance> covariance_;  ///< covariance of u_x, u_y, β_x, β_y
  double vertical_ = 0;            ///< m/s²
  double turned_ = 0, time_ = 0;   ///< rad, s: since the last age()
};

}  // namespace robot_control
