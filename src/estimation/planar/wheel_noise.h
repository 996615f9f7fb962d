#pragma once
/// How much the wheels' travel scatters: slip noise of a side, m/√m, and turn noise, rad/√rad, learned from the
/// innovations of the planar core (planar_core.h).
///
///   slips = slip² rolled ρ      twists = (B twist angle)² / angle ρ      ρ = (1 + r)/(1 − r)
///
/// are their parts of the variance s of an innovation; r is the correlation of neighbouring innovations, which bend the
/// path as often as noise of ρ times the variance. After each innovation ν of variance s, with its share of s,
///
///   log level ← log level ± kLevelStep · share        + where |ν|/√s exceeds the median of a normal distribution
///
/// (H. Robbins, S. Monro, A stochastic approximation method, 1951), from a pessimistic start.

#include <algorithm>
#include <cmath>

#include "estimation/tuning.h"
#include "estimation/values.h"

namespace robot_control {

class WheelNoise {
 public:
  /// m², of right − left.
  struct Variances {
    double slips = 0, twists = 0;
  };

  /// `least_slip`: m/√m, of the best floor; `first_twist`: rad/√rad.
  WheelNoise(double least_slip, double first_twist) noexcept
      : least_(least_slip), slip_(std::max(Tuning::kFirstSlip, least_slip)), twist_(first_twist) {}

  /// `rolled`: m, of both sides, `angle`: rad, `wheel_base`: m.
  Variances variances(double rolled, double angle, double wheel_base) const noexcept {
    const double correlation = std::clamp(correlation_ / power_, 0.0, Tuning::kLargestCorrelation);
    const double repeated = (1 + correlation) / (1 - correlation);
    return {square(slip_) * rolled * repeated, square(wheel_base * twist_) * std::abs(angle) * repeated};
  }

  /// `normalised`: an innovation over its deviation √s, `parts` of s.
  void learn(double normalised, const Variances& parts, double s) noexcept {
    constexpr double kNormalMedian = 0.6745;  // deviations, of |normal|
    const double bounded = std::clamp(normalised, -Tuning::kSignificant, Tuning::kSignificant);
    correlation_ += Tuning::kLevelMemory * (bounded * last_ - correlation_);
    power_ = std::max(0.1, power_ + Tuning::kLevelMemory * (bounded * bounded - power_));
    last_ = bounded;
    const double step = std::abs(normalised) > kNormalMedian ? Tuning::kLevelStep : -Tuning::kLevelStep;
    twist_ = std::clamp(twist_ * std::exp(step * parts.twists / s), Tuning::kLeastTwist, Tuning::kLargestTwist);
    slip_ = std::clamp(slip_ * std::exp(step * parts.slips / s), least_, Tuning::kLargestSlip);
  }

  double slip() const noexcept { return slip_; }    ///< m/√m
  double twist() const noexcept { return twist_; }  ///< rad/√rad

 private:
  double least_;
  double slip_;
  double twist_;
  double last_ = 0, correlation_ = 0, power_ = 1;  ///< of the normalised innovations
};

}  // namespace robot_control
