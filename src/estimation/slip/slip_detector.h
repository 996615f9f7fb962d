#pragma once
/// Detects slip by the residuals of wheels against gyro and accelerometer (slip_residual.h) over four spans T. Each is
/// compared with its usual level (residual_levels.h).
///
/// Slip is proven if a residual exceeds kProof deviations and that of the next longer T kSignificant. The second
/// condition excludes a late time stamp, which is as large in every T, while σ grows with T. Without slip, the mean of
/// −D/T² along and across is the error of gravity and bias in the acceleration.

#include <array>

#include "estimation/slip/residual_levels.h"

namespace robot_control {

class SlipDetector {
 public:
  using Channel = SlipResidual::Channel;

  SlipDetector() = default;
  explicit SlipDetector(const SlipParams& params) noexcept : difference_(params), levels_(params) {}

  void restart() noexcept;  ///< restarts the differences (motion_difference.h); the levels stay
  void restart_on_line(const Planar& slope) noexcept;
  void restart_at_rest(double yaw, const Vector3& up, const Planar& velocity) noexcept;
  void begin_path() noexcept { difference_.begin_path(); }
  void set_clock_offset(double offset) noexcept { difference_.set_clock_offset(offset); }  ///< s; not during a slide
  /// Returns true if a point was added, which may be judged.
  bool step(const MotionDifference::Sample& sample) noexcept { return difference_.step(sample); }
  /// Judges a point. `learns` states that no slide is active.
  void evaluate(const SlipUncertainty& uncertainty, bool learns) noexcept;

  const MotionDifference& difference() const noexcept { return difference_; }
  const ResidualLevels& levels() const noexcept { return levels_; }

  // The members below describe the last judgement.
  bool proven(Channel channel) const noexcept { return proven_span_[channel] > 0; }
  double shortest_proven_span() const noexcept;                         ///< s, of all channels; 0: none
  double nis(Channel channel) const noexcept { return nis_[channel]; }  ///< at T = 0.2 s; < 0: unknown
  /// Returns the deviation of the slope of E or W over T = 0.1 s, in m/s.
  double slope_deviation(Channel channel) const noexcept { return slope_deviation_[channel]; }

  /// Describes the excess of gravity over the value in use, in base axes.
  struct GravityError {
    bool known = false;
    double along = 0, across = 0;  ///< m/s²
    double deviation = 0;          ///< m/s²
    double interval = 0;           ///< s since the last one
  };
  const GravityError& gravity_error() const noexcept { return gravity_error_; }

  /// Returns the learned noise while driving. `variance` ((m/s²)²) is that of gravity and bias.
  AccelerationNoise acceleration_noise(double variance) const noexcept {
    return levels_.acceleration_noise(speed_, variance);
  }

 private:
  using Residuals = std::array<SlipResidual, ResidualLevels::kSpans>;

  void forget_judgement() noexcept;
  void evaluate_channel(Channel channel, const Residuals& residuals, const SlipUncertainty& uncertainty) noexcept;
  void compare_gravity(const SlipResidual& residual, double speed_step, bool learns) noexcept;

  MotionDifference difference_;
  ResidualLevels levels_;
  std::array<double, SlipResidual::kChannels> proven_span_{};
  std::array<double, SlipResidual::kChannels> nis_{-1, -1, -1};
  std::array<double, SlipResidual::kChannels> slope_deviation_{};
  GravityError gravity_error_;
  double gravity_compared_at_ = 0;  ///< s
  double speed_ = 0;                ///< m/s
};

}  // namespace robot_control
