#pragma once
/// The wheel noise describes how the travel of the wheels scatters: slip noise of a side, m/√m, and turn noise,
/// rad/√rad. It is learned from the innovations of the planar core (planar_core.h), whose variance s contains the parts
///
///   slips = slip² rolled      twists = (B twist)² |angle|
///
/// Here B is the wheel base. After each innovation ν, either level changes by its share of s,
///
///   log level ← log level ± kLevelStep · share        + where |ν|/√s exceeds the median of a normal distribution
///
/// (H. Robbins, S. Monro, A stochastic approximation method, 1951). The levels start pessimistic.

#include <algorithm>
#include <cmath>

#include "estimation/common/tuning.h"
#include "estimation/common/values.h"

namespace robot_control {

class WheelNoise {
 public:
  /// Holds the parts of the variance of right − left, in m².
  struct Variances {
    double slips = 0, twists = 0;
  };

  /// `least` (m/√m) is that of the best floor. Wheels that no turn drags begin with a fifth of the noise.
  WheelNoise(double least, bool drags_wheels) noexcept
      : least_(least),
        slip_(std::max(least, drags_wheels ? Tuning::kFirstSlip : Tuning::kFirstSlip / 5)),
        twist_(drags_wheels ? kScrub : kScrub / 5) {}

  /// `rolled` is the sum of both sides in m, `angle` is in rad and `wheel_base` in m.
  Variances variances(double rolled, double angle, double wheel_base) const noexcept {
    return {square(slip_) * rolled, square(wheel_base * twist_) * std::abs(angle)};
  }

  /// `normalised` is an innovation over its deviation √s; `parts` are the parts of s.
  void learn(double normalised, const Variances& parts, double s) noexcept {
    constexpr double kNormalMedian = 0.6745;  // deviations, median of |normal|
    const double step = std::abs(normalised) > kNormalMedian ? Tuning::kLevelStep : -Tuning::kLevelStep;
    twist_ = std::clamp(twist_ * std::exp(step * parts.twists / s), kMinTwist, 1.0);
    slip_ = std::clamp(slip_ * std::exp(step * parts.slips / s), least_, kMaxSlip);
  }

  double slip() const noexcept { return slip_; }    ///< m/√m
  double twist() const noexcept { return twist_; }  ///< rad/√rad

 private:
  static constexpr double kScrub = Tuning::kFirstScrub;
  static constexpr double kMinTwist = 5e-4;  ///< rad/√rad, of a hard tyre on a hard floor
  static constexpr double kMaxSlip = 0.05;   ///< m/√m, ten times that of skid steers
  double least_, slip_, twist_;
};

}  // namespace robot_control
