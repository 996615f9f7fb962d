#pragma once
/// The direction of the vertical in base axes, from gyro and accelerometer alone: the monitor's own estimate,
/// independent of the estimator.
///
///   prediction (gyro)            as in fixed_direction.h
///   correction (accelerometer)   by â with weight dt/T,   â = (a − c)/|a − c|,   if ||a − c| − g| < kBand
///   initial value                u = â, of the first sample within the band
///
/// a  accelerometer: specific force, +g upwards at rest; c  the part of it that the caller knows not to be gravity.
///    With `force_time`, a − c is its low pass, which turns with the gyro: a body on legs falls and rises in each step,
///    so that one sample in five is within the band, and these all belong to the same moment of a step
/// u  always of unit length. If a sample of one device is missing or too large to be squared, the other is used alone
///
/// Errors of u [rad], T = 1.5 s, b a gyro's bias, A an acceleration along the ground that is not in c:
///
///   bias              ≤ b T            0.05 rad/s: 0.075
///   acceleration      ≤ A/g·(1 − e^{−t/T}) ≤ Δv/(g T)    1 m/s² for 1 s: 0.050; from 1 m/s at 4.5 m/s²: 0.068;
///                                      5 m/s²: 0, because above √(2 g kBand + kBand²) = 4.5 m/s² the band excludes it
///   offset of a       δ/g              0.2 m/s²: 0.020
///   start in motion   A/g of the first sample, decays with e^{−t/T}
///
/// T balances the first two: b T = Δv/(g T) for b = 0.05 rad/s and Δv = 1 m/s gives T = 1.4 s. kBand: three standard
/// deviations of an offset of 0.2 m/s² and of noise of 0.05 m/s², and 1 m/s² of braking, which adds 0.05 m/s² to |a|.
///
/// After kTrustTime without a correction u is unknown, because of the gyro's bias, until the next correction, which
/// sets u = â.
///
/// (Complementary filter: R. Mahony, T. Hamel, J.-M. Pflimlin, IEEE TAC 53 (2008) 1203, for the vertical only.)

#include <Eigen/Core>

#include "machine/stored.h"
#include "safety/measurements/fixed_direction.h"

namespace robot_control {

class Attitude {
 public:
  static constexpr double kTimeConstant = 1.5;  ///< s, T
  static constexpr double kBand = 1.0;          ///< m/s²
  static constexpr double kTrustTime = 3.0;     ///< s, 0.15 rad of a bias of 0.05 rad/s

  /// `force_time`: s, of the low pass of a − c; 0: none.
  explicit Attitude(double force_time = 0) noexcept : force_time_(force_time) {}

  void reset() noexcept { *this = Attitude(force_time_); }

  /// Base axes: `rate` ω, rad/s, null without a gyro; `force` a − c, m/s², null without an accelerometer; finite.
  /// `dt` s since the last step.
  void step(const Eigen::Vector3d* rate, const Eigen::Vector3d* force, double dt) noexcept;

  bool known() const noexcept { return uncorrected_ <= kTrustTime; }

  /// u; while it is not known, the base's z axis or the last one known.
  Eigen::Vector3d up() const noexcept { return up_.vector(); }
  const FixedDirection& vertical() const noexcept { return up_; }

  /// As those of fixed_direction.h; the rate is 0 without a gyro.
  double tilt() const noexcept { return up_.tilt(); }
  bool surely_within(double angle) const noexcept { return up_.surely_within(angle); }
  double tilt_rate() const noexcept { return tilt_rate_; }

 private:
  static constexpr double kMaxForce = 160;  ///< m/s²; accelerometers measure up to 16 g

  Eigen::Vector3d smooth(const Eigen::Vector3d& force, double dt) noexcept;
  void pull(const Eigen::Vector3d& force, double dt) noexcept;

  double force_time_;
  Stored<Eigen::Vector3d> force_;  ///< m/s², the low pass; zero before the first sample
  FixedDirection up_;
  double uncorrected_ = 2 * kTrustTime;  ///< s since the last correction
  double tilt_rate_ = 0;
};

}  // namespace robot_control
