#include "estimation/slip/slip_detector.h"

#include <cmath>

namespace robot_control {

void SlipDetector::forget_judgement() noexcept {
  proven_span_ = {};
  nis_.fill(-1);
  gravity_error_ = {};
  gravity_compared_at_ = difference_.time();
}

void SlipDetector::restart() noexcept {
  difference_.restart();
  levels_.restart();
  forget_judgement();
}

void SlipDetector::restart_on_line(const Planar& slope) noexcept {
  difference_.restart_on_line(slope);
  forget_judgement();
}

void SlipDetector::restart_at_rest(double yaw, const Vector3& up, const Planar& velocity) noexcept {
  difference_.restart_at_rest(yaw, up, velocity);
  levels_.restart();
  forget_judgement();
}

void SlipDetector::evaluate(const SlipUncertainty& uncertainty, bool learns) noexcept {
  Residuals residuals;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    residuals[i] = slip_residual(difference_, Tuning::kResidualSpans[i]);
  }
  const SlipResidual& tilt = residuals[ResidualLevels::kTiltSpan];
  if (tilt.known) speed_ = tilt.speed();
  for (const Channel channel : SlipResidual::kEach) evaluate_channel(channel, residuals, uncertainty);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    levels_.learn(difference_.time(), i, residuals[i], uncertainty, !learns);
  }
  compare_gravity(tilt, uncertainty.speed_step, learns);
}

void SlipDetector::evaluate_channel(Channel channel, const Residuals& residuals,
                                    const SlipUncertainty& uncertainty) noexcept {
  std::array<double, ResidualLevels::kSpans> deviation{};
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (residuals[i].known) deviation[i] = levels_.deviation(i, channel, residuals[i], uncertainty);
  }
  const auto exceeds = [&](std::size_t i, double deviations) {
    return residuals[i].known && std::abs(residuals[i].value[channel]) > deviations * deviation[i];
  };
  std::size_t shortest = 0;
  while (shortest + 1 < residuals.size() &&
         !(exceeds(shortest, Tuning::kProof) && exceeds(shortest + 1, Tuning::kSignificant))) {
    ++shortest;
  }
  const bool proven = shortest + 1 < residuals.size();
  proven_span_[channel] = proven ? residuals[shortest].span : 0;
  constexpr std::size_t kLevel = ResidualLevels::kLevelSpan;
  if (residuals[0].known) {
    slope_deviation_[channel] = levels_.usual_deviation(0, channel, residuals[0], uncertainty) / residuals[0].span;
  }
  nis_[channel] = residuals[kLevel].known ? square(residuals[kLevel].value[channel] / deviation[kLevel]) : -1;
}

/// The deviation is that of the residual alone, because gravity's own uncertainty is what this comparison reduces.
void SlipDetector::compare_gravity(const SlipResidual& residual, double speed_step, bool learns) noexcept {
  gravity_error_.known = false;
  const double interval = difference_.time() - gravity_compared_at_;
  if (!residual.known || !learns || interval < residual.span) return;
  const double squared = square(residual.span);
  const double deviation =
      levels_.deviation(ResidualLevels::kTiltSpan, SlipResidual::kAlong, residual, {.speed_step = speed_step});
  gravity_error_ = {.known = true,
                    .along = -residual.value[SlipResidual::kAlong] / squared,
                    .across = -residual.value[SlipResidual::kAcross] / squared,
                    .deviation = deviation / squared,
                    .interval = interval};
  gravity_compared_at_ = difference_.time();
}

double SlipDetector::shortest_proven_span() const noexcept {
  double shortest = 0;
  for (const double span : proven_span_) {
    if (span > 0 && (shortest == 0 || span < shortest)) shortest = span;
  }
  return shortest;
}

}  // namespace robot_control
