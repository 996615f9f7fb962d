#pragma once
/// The rate tracker smooths the gyro's samples to the angular velocity that is published.
///
/// It is a second-order tracking loop (fading-memory α-β filter; E. Brookner, Tracking and Kalman Filtering Made Easy,
/// 1998, section 1.2) for each axis:
///
///   predict  ω ← ω + a·dt,  e = measured − ω          β = exp(−2π · bandwidth · dt)
///   correct  ω ← ω + (1 − β²)·e,  a ← a + (1 − β)²·e/dt
///
/// The two poles are equal. The error vanishes at constant angular acceleration. At constant jerk j the lag is
/// j/(2π·bandwidth)², which is 2.5 mrad/s at 20 Hz and 40 rad/s³.

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "estimation/common/values.h"

namespace robot_control {

class RateTracker {
 public:
  /// `bandwidth` is in Hz, `period` in s; both are > 0.
  RateTracker(double bandwidth, double period) noexcept
      : bandwidth_(bandwidth), period_(period), period_beta_(beta(period)) {}

  /// `rate` is in rad/s.
  void reset(const Eigen::Vector3d& rate) noexcept {
    *rate_ = rate;
    (*acceleration_).setZero();
  }

  /// `measured` is in rad/s, `dt` > 0 s after the last one.
  void step(const Eigen::Vector3d& measured, double dt) noexcept {
    const double b = dt == period_ ? period_beta_ : beta(dt);
    *rate_ += dt * *acceleration_;
    const Eigen::Vector3d error = measured - *rate_;
    *rate_ += (1 - b * b) * error;
    *acceleration_ += (1 - b) * (1 - b) / dt * error;
  }

  /// Follows `measured`, smoothed from the second step in a row with `smooth`. At rest, in the first step of a motion
  /// and without a gyro there is nothing to smooth.
  void follow(const Eigen::Vector3d& measured, bool smooth, double dt) noexcept {
    if (!smooth || !following_) {
      reset(measured);
    } else if (dt > 0) {
      step(measured, dt);
    }
    following_ = smooth;
  }

  Eigen::Vector3d rate() const noexcept { return *rate_; }  ///< rad/s

  /// Returns the variance of `rate` over that of a white gyro's samples. Each `measured` is the mean of two neighbours.
  double noise_gain() const noexcept {
    const double b = period_beta_;
    return (1 - b) * (1 + 2 * b + 2 * b * b) / (2 * (1 + b));
  }

 private:
  double beta(double dt) const noexcept { return std::exp(-2 * std::numbers::pi * bandwidth_ * dt); }

  double bandwidth_;
  double period_;
  double period_beta_;
  bool following_ = false;
  Stored<Eigen::Vector3d> rate_;
  Stored<Eigen::Vector3d> acceleration_;  ///< rad/s²
};

}  // namespace robot_control
