#include "estimation/wheeled/slip/slip_detector.h"

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
  learned_at_ = {};
  forget_judgement();
}

void SlipDetector::restart_on_line(const Planar& slope) noexcept {
  difference_.restart_on_line(slope);
  forget_judgement();
}

void SlipDetector::restart_at_rest(double yaw, const Vector3& up, const Planar& velocity) noexcept {
  difference_.restart_at_rest(yaw, up, velocity);
  learned_at_ = {};
  forget_judgement();
}

void SlipDetector::evaluate(const SlipUncertainty& uncertainty, bool learns) noexcept {
  uncertainty_ = uncertainty;
  Residuals residuals;
  for (std::size_t i = 0; i < kSpans; ++i) residuals[i] = slip_residual(difference_, Tuning::kResidualSpans[i]);
  if (residuals[kTiltSpan].known) speed_ = residuals[kTiltSpan].speed();
  for (const Channel channel : SlipResidual::kEach) evaluate_channel(channel, residuals);
  for (std::size_t i = 0; i < kSpans; ++i) learn(i, residuals[i], !learns);
  compare_gravity(residuals[kTiltSpan], learns);
}

double SlipDetector::at_speed(double level, double speed) const noexcept {
  if (level == 0) return Tuning::kFirstLevel;
  const double faster = std::max(1.0, speed / std::max(Tuning::kSlowestComparison, usual_speed_));
  return std::sqrt(1 + (square(level) - 1) * square(faster));
}

/// Returns the learned standard deviation of a residual without the clock offset, in m.
double SlipDetector::deviation(std::size_t span, Channel channel, const SlipResidual& residual) const noexcept {
  return at_speed(levels_[span][channel].in_use(), residual.speed()) *
         residual_deviation(channel, residual, uncertainty_, params_);
}

void SlipDetector::evaluate_channel(Channel channel, const Residuals& residuals) noexcept {
  std::array<double, kSpans> normalised{};  // 0: unknown
  for (std::size_t i = 0; i < kSpans; ++i) {
    const SlipResidual& residual = residuals[i];
    if (!residual.known) continue;
    const double change =
        channel == SlipResidual::kTurn ? params_.wheel_base * residual.yaw_rate_change : residual.speed_change;
    const double usual = deviation(i, channel, residual);
    normalised[i] = std::abs(residual.value[channel]) / std::hypot(usual, uncertainty_.clock_offset * change);
    if (i == 0) slope_deviation_[channel] = usual / residual.span;
  }
  proven_span_[channel] = 0;
  for (std::size_t i = kSpans - 1; i-- > 0;) {
    const bool proven = normalised[i] > Tuning::kProof && normalised[i + 1] > Tuning::kSignificant;
    if (proven) proven_span_[channel] = residuals[i].span;
  }
  nis_[channel] = residuals[kLevelSpan].known ? square(normalised[kLevelSpan]) : -1;
}

/// Learns once per span. Slip excludes a residual, unless no level has been learned yet.
void SlipDetector::learn(std::size_t span, const SlipResidual& residual, bool slip) noexcept {
  auto& levels = levels_[span];
  const bool unknown = levels[SlipResidual::kAlong].value == 0;
  const bool moves = residual.known && residual.distance > Tuning::kSlowestComparison * residual.span;
  if ((slip && !unknown) || !moves || !(difference_.time() - learned_at_[span] >= residual.span)) return;
  learned_at_[span] = difference_.time();
  if (span == kTiltSpan) {
    const double share = 1.0 / static_cast<double>(levels[SlipResidual::kAlong].count + 1);
    usual_speed_ += std::max(Tuning::kForgetting, share) * (residual.speed() - usual_speed_);
  }
  for (const Channel channel : SlipResidual::kEach) {
    const double nominal = residual_deviation(channel, residual, uncertainty_, params_);
    learn_level(levels[channel], std::abs(residual.value[channel]) / nominal / Tuning::kNormal90);
  }
}

void SlipDetector::learn_level(Level& level, double ratio) noexcept {
  if (++level.count > Tuning::kFirstResiduals) {
    level.value = std::max(1.0, level.value * std::exp((ratio > level.value ? 0.9 : -0.1) * Tuning::kQuantileStep));
    level.mean += Tuning::kForgetting * (level.value - level.mean);
    return;
  }
  level.largest = std::max(level.largest, ratio);
  if (level.count == Tuning::kFirstResiduals) level.value = level.mean = std::max(1.0, level.largest);
}

AccelerationNoise SlipDetector::acceleration_noise() const noexcept {
  const double factor = at_speed(levels_[kTiltSpan][SlipResidual::kAlong].in_use(), speed_);
  const double variance = std::max(uncertainty_.acceleration_variance[0], uncertainty_.acceleration_variance[1]);
  return {.white = factor * params_.accelerometer,
          .slow = std::sqrt(square(factor * Tuning::kSlowAcceleration) + variance)};
}

/// The deviation is that of the residual alone, because gravity's own uncertainty is what this comparison reduces.
void SlipDetector::compare_gravity(const SlipResidual& residual, bool learns) noexcept {
  gravity_error_.known = false;
  const double interval = difference_.time() - gravity_compared_at_;
  if (!residual.known || !learns || interval < residual.span) return;
  const double squared = square(residual.span);
  const SlipUncertainty alone{.speed_step = uncertainty_.speed_step};
  const double level = at_speed(levels_[kTiltSpan][SlipResidual::kAlong].in_use(), residual.speed());
  gravity_error_ = {.known = true,
                    .along = -residual.value[SlipResidual::kAlong] / squared,
                    .across = -residual.value[SlipResidual::kAcross] / squared,
                    .deviation = level * residual_deviation(SlipResidual::kAlong, residual, alone, params_) / squared,
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

SlipResidual slip_residual(const MotionDifference& difference, double span) noexcept {
  const MotionDifference::Point end = difference.last();
  const MotionDifference::Point middle = difference.before(end.time - 0.9 * span);
  const double late = end.time - middle.time;
  const MotionDifference::Point first = difference.before(middle.time - 0.9 * late);
  const double early = middle.time - first.time;
  SlipResidual residual;
  residual.known = late > 0.8 * span && late < 1.6 * span && early > 0.8 * late && early < 1.6 * late;
  if (!residual.known) return residual;
  residual.span = late;
  residual.distance = end.distance - first.distance;
  residual.turned = end.yaw - first.yaw;
  residual.yaw_rate_change = end.yaw_rate - middle.yaw_rate;
  const Planar bend =
      end.path_difference - middle.path_difference - (middle.path_difference - first.path_difference) * late / early;
  const Planar inertial_change = end.velocity - first.velocity;
  const Planar wheel_change = inertial_change + bend * 2 / late;
  residual.speed_change = std::min({residual.distance / late, inertial_change.norm(), wheel_change.norm()});
  const Planar in_base = rotated(bend, -middle.yaw);
  residual.value = {in_base.x, in_base.y, end.turn_difference - middle.turn_difference};
  return residual;
}

double residual_deviation(SlipResidual::Channel channel, const SlipResidual& residual,
                          const SlipUncertainty& uncertainty, const SlipParams& params) noexcept {
  const double span = residual.span;
  if (channel == SlipResidual::kTurn) {
    const double base = params.wheel_base;
    return std::sqrt(4 * square(params.encoder) + 2 * square(params.wheel_slip_noise) * residual.distance +
                     square(base * uncertainty.wheel_base * residual.turned) +
                     square(base * Tuning::kWindUp) * std::abs(residual.yaw_rate_change) +
                     square(uncertainty.speed_step * span) / 6);
  }
  const double slow = square(Tuning::kSlowAcceleration) + uncertainty.acceleration_variance[channel];
  return std::sqrt(6 * square(params.encoder) + square(params.accelerometer) * span * span * span * 2 / 3 +
                   slow * square(span * span) + 2 * square(Tuning::kPathSlip) * residual.distance +
                   square(uncertainty.speed_step * span) / 12);
}

}  // namespace robot_control
