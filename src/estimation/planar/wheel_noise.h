#pragma once
/// The wheel noise describes how the travel of the wheels scatters: slip noise of a side, m/√m, and turn noise,
/// rad/√rad. It is learned from the innovations of the planar core (planar_core.h), whose variance s contains the parts
///
///   slips = slip² rolled ρ      twists = (B twist angle)² / angle ρ      ρ = (1 + r)/(1 − r)
///
/// Here r is the correlation of neighbouring innovations; correlated errors bend the path like uncorrelated ones of ρ
/// times the variance. After each innovation ν, either level changes by its share of s,
///
///   log level ← log level ± kLevelStep · share        + where |ν|/√s exceeds the median of a normal distribution
///
/// (H. Robbins, S. Monro, A stochastic approximation method, 1951). The levels start pessimistic.

#include <algorithm>
#include <cmath>

#include "estimation/tuning.h"
#include "estimation/values.h"

namespace robot_control {

class WheelNoise {
 public:
  /// Holds the parts of the variance of right − left, in m².
  struct Variances {
    double slips = 0, twists = 0;
  };

  /// `least_slip` (m/√m) is that of the best floor; `first_twist` is in rad/√rad.
  WheelNoise(double least_slip, double first_twist) noexcept
      : least_(least_slip), slip_(std::max(Tuning::kFirstSlip, least_slip)), twist_(first_twist) {}

  /// `rolled` is the sum of both sides in m, `angle` is in rad and `wheel_base` in m.
  Variances variances(double rolled, double angle, double wheel_base) const noexcept {
    const double correlation = std::clamp(correlation_ / power_, 0.0, Tuning::kMaxCorrelation);
    const double repeated = (1 + correlation) / (1 - correlation);
    return {square(slip_) * rolled * repeated, square(wheel_base * twist_) * std::abs(angle) * repeated};
  }

  /// `normalised` is an innovation over its deviation √s; `parts` are the parts of s.
  void learn(double normalised, const Variances& parts, double s) noexcept {
    constexpr double kNormalMedian = 0.6745;  // deviations, median of |normal|
    const double bounded = std::clamp(normalised, -Tuning::kSignificant, Tuning::kSignificant);
    correlation_ += Tuning::kLevelMemory * (bounded * last_ - correlation_);
    power_ = std::max(0.1, power_ + Tuning::kLevelMemory * (bounded * bounded - power_));
    last_ = bounded;
    const double step = std::abs(normalised) > kNormalMedian ? Tuning::kLevelStep : -Tuning::kLevelStep;
    twist_ = std::clamp(twist_ * std::exp(step * parts.twists / s), Tuning::kMinTwistNoise, Tuning::kMaxTwistNoise);
    slip_ = std::clamp(slip_ * std::exp(step * parts.slips / s), least_, Tuning::kMaxSlipNoise);
  }

  double slip() const noexcept { return slip_; }    ///< m/√m
  double twist() const noexcept { return twist_; }  ///< rad/√rad

 private:
  double least_;
  double slip_;
  double twist_;
  double last_ = 0, correlation_ = 0, power_ = 1;  ///< moments of the normalised innovations
};

}  // namespace robot_control
