#pragma once
/// Learns how large the residuals of wheels and inertial sensors (slip_residual.h) usually are on this robot and floor.
///
/// Real floors shake an accelerometer ten to forty times harder than its data sheet states. Therefore each span T of
/// each channel learns a level ≥ 1: the 90 % quantile of |residual|/σ, over that of a normal distribution. Here σ
/// follows from the data sheets. The first level is the largest of kFirstResiduals residuals; before that it is
/// kFirstLevel. Later the logarithm of the level changes by steps of kQuantileStep (H. Robbins, S. Monro, A stochastic
/// approximation method, 1951).
///
/// A robot that drives faster shakes more: the excess over the sensors' noise grows in proportion to the speed. The
/// clock offset's uncertainty σ_τ adds (σ_τ speed change)², and (B σ_τ Δω)² in the turn. It adds nothing at constant
/// speed.

#include <array>
#include <cstdint>

#include "estimation/slip/slip_residual.h"

namespace robot_control {

/// Holds standard deviations of the acceleration.
struct AccelerationNoise {
  double white = 0;  ///< m/s²/√Hz
  double slow = 0;   ///< m/s²
};

class ResidualLevels {
 public:
  static constexpr std::size_t kSpans = Tuning::kResidualSpans.size();
  static constexpr std::size_t kLevelSpan = 1;  ///< index of T = 0.2 s, whose level is published
  static constexpr std::size_t kTiltSpan = 2;   ///< index of T = 0.4 s, from which tilt and noise are learned
  using Channel = SlipResidual::Channel;

  ResidualLevels() = default;
  explicit ResidualLevels(const SlipParams& params) noexcept : params_(params) {}

  void restart() noexcept { learned_at_ = {}; }  ///< Time begins at 0 again; the levels stay.

  /// Returns the learned standard deviation of a residual, in m.
  double deviation(std::size_t span, Channel channel, const SlipResidual& residual,
                   const SlipUncertainty& uncertainty) const noexcept;

  /// Returns the same without the clock offset, for a robot that keeps its speed.
  double usual_deviation(std::size_t span, Channel channel, const SlipResidual& residual,
                         const SlipUncertainty& uncertainty) const noexcept;

  /// Learns at `time` (s), once per span. Slip excludes a residual, unless no level has been learned yet.
  void learn(double time, std::size_t span, const SlipResidual& residual, const SlipUncertainty& uncertainty,
             bool slip) noexcept;

  /// Returns the level along at T = 0.2 s; 0: nothing was compared yet.
  double level() const noexcept { return level_[kLevelSpan][SlipResidual::kAlong]; }
  /// Returns the noise at that speed (m/s). `variance` ((m/s²)²) is that of gravity and bias.
  AccelerationNoise acceleration_noise(double speed, double variance) const noexcept;

 private:
  /// Holds one level for each span and channel.
  using Levels = std::array<std::array<double, SlipResidual::kChannels>, kSpans>;

  /// Returns the level at that speed (m/s); a level of 0 is not learned yet.
  double at_speed(double level, double speed) const noexcept;
  void learn_level(std::size_t span, Channel channel, double ratio) noexcept;

  SlipParams params_;
  Levels level_{};    ///< 0: unknown
  Levels largest_{};  ///< largest of the first residuals
  std::array<std::array<std::uint64_t, SlipResidual::kChannels>, kSpans> count_{};
  std::array<double, kSpans> learned_at_{};  ///< s
  double usual_speed_ = 0;                   ///< m/s, speed at which the levels are learned
};

}  // namespace robot_control
