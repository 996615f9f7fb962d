#pragma once
/// How large the residuals of wheels and inertial sensors (slip_residual.h) usually are on this robot and floor.
///
/// Real floors shake an accelerometer ten to forty times harder than its data sheet says. So each span T of each
/// channel learns a level: the 90 % quantile of |residual|/σ, over that of a normal distribution, with σ by the data
/// sheets. It moves by steps of kQuantileStep on its logarithm (H. Robbins, S. Monro, A stochastic approximation
/// method, 1951), from the largest of the first kFirstResiduals on, and is at least 1. Before that it is kFirstLevel,
/// that of a robot that shakes.
///
/// A robot that drives faster than usual shakes more: what exceeds the sensors' noise grows in proportion to the speed.
/// The clock offset's uncertainty σ_τ adds (σ_τ speed change)², and (B σ_τ Δω)² in the turn: no offset bends E while
/// the wheels keep their speed.

#include <array>
#include <cstdint>

#include "estimation/slip/slip_residual.h"

namespace robot_control {

/// Of the acceleration, standard deviations.
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

  void restart() noexcept { learned_at_ = {}; }  ///< time begins at 0 again; the levels stay

  /// m, standard deviation of a residual, as learned.
  double deviation(std::size_t span, Channel channel, const SlipResidual& residual,
                   const SlipUncertainty& uncertainty) const noexcept;

  /// The same without the clock offset: of a robot that keeps its speed.
  double usual_deviation(std::size_t span, Channel channel, const SlipResidual& residual,
                         const SlipUncertainty& uncertainty) const noexcept;

  /// At `time`, s; once per span. Where nothing was learned yet it learns although wheels may slip.
  void learn(double time, std::size_t span, const SlipResidual& residual, const SlipUncertainty& uncertainty,
             bool slip) noexcept;

  /// Along, of T = 0.2 s; 0: nothing was compared yet.
  double level() const noexcept { return level_[kLevelSpan][SlipResidual::kAlong]; }
  /// At that speed, m/s; `variance` (m/s²)²: of gravity and bias.
  AccelerationNoise acceleration_noise(double speed, double variance) const noexcept;

 private:
  /// Of each span and channel.
  using Levels = std::array<std::array<double, SlipResidual::kChannels>, kSpans>;

  /// Of a level that was learned, or 0, at that speed, m/s.
  double at_speed(double level, double speed) const noexcept;
  void learn_level(std::size_t span, Channel channel, double ratio) noexcept;

  SlipParams params_;
  Levels level_{};    ///< 0: unknown
  Levels largest_{};  ///< of the first residuals
  std::array<std::array<std::uint64_t, SlipResidual::kChannels>, kSpans> count_{};
  std::array<double, kSpans> learned_at_{};  ///< s
  double usual_speed_ = 0;                   ///< m/s, at which the levels are learned
};

}  // namespace robot_control
