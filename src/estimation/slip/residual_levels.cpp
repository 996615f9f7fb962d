#include "estimation/slip/residual_levels.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

double ResidualLevels::at_speed(double level, double speed) const noexcept {
  if (level == 0) return Tuning::kFirstLevel;
  const double faster = std::max(1.0, speed / std::max(Tuning::kSlowestComparison, usual_speed_));
  return std::sqrt(1 + (square(level) - 1) * square(faster));
}

double ResidualLevels::usual_deviation(std::size_t span, Channel channel, const SlipResidual& residual,
                                       const SlipUncertainty& uncertainty) const noexcept {
  return at_speed(level_[span][channel], residual.speed()) *
         residual_deviation(channel, residual, uncertainty, params_);
}

double ResidualLevels::deviation(std::size_t span, Channel channel, const SlipResidual& residual,
                                 const SlipUncertainty& uncertainty) const noexcept {
  const double change =
      channel == SlipResidual::kTurn ? params_.wheel_base * residual.yaw_rate_change : residual.speed_change;
  return std::hypot(usual_deviation(span, channel, residual, uncertainty), uncertainty.clock_offset * change);
}

void ResidualLevels::learn(double time, std::size_t span, const SlipResidual& residual,
                           const SlipUncertainty& uncertainty, bool slip) noexcept {
  const bool unknown = level_[span][SlipResidual::kAlong] == 0;
  const bool moves = residual.known && residual.distance > Tuning::kSlowestComparison * residual.span;
  if ((slip && !unknown) || !moves || !(time - learned_at_[span] >= residual.span)) return;
  learned_at_[span] = time;
  if (span == kTiltSpan) {
    const double share = 1.0 / static_cast<double>(count_[span][SlipResidual::kAlong] + 1);
    usual_speed_ += std::max(Tuning::kForgetting, share) * (residual.speed() - usual_speed_);
  }
  for (const Channel channel : SlipResidual::kEach) {
    const double nominal = residual_deviation(channel, residual, uncertainty, params_);
    learn_level(span, channel, std::abs(residual.value[channel]) / nominal / Tuning::kNormal90);
  }
}

void ResidualLevels::learn_level(std::size_t span, Channel channel, double ratio) noexcept {
  double& level = level_[span][channel];
  double& largest = largest_[span][channel];
  const std::uint64_t count = ++count_[span][channel];
  if (count <= Tuning::kFirstResiduals) largest = std::max(largest, ratio);
  if (count == Tuning::kFirstResiduals) level = std::max(1.0, largest);
  if (count <= Tuning::kFirstResiduals) return;
  level = std::max(1.0, level * std::exp((ratio > level ? 0.9 : -0.1) * Tuning::kQuantileStep));
}

AccelerationNoise ResidualLevels::acceleration_noise(double speed, double variance) const noexcept {
  const double factor = at_speed(level_[kTiltSpan][SlipResidual::kAlong], speed);
  return {.white = factor * params_.accelerometer,
          .slow = std::sqrt(square(factor * Tuning::kSlowAcceleration) + variance)};
}

}  // namespace robot_control
