#include "estimation/simple/slip_evidence.h"

#include <algorithm>
#include <cmath>

#include "estimation/simple/tilt.h"
#include "signals/state_frame.h"

namespace robot_control {
namespace {

constexpr double kNormal90 = 1.645;    // deviations, the 90 % quantile of |normal|
constexpr std::size_t kLevelSpan = 1;  // index of T = 0.2 s
constexpr std::size_t kTiltSpan = 2;   // index of T = 0.4 s
constexpr std::size_t kSideways = 2;   // channel
constexpr double kUnknown = -1;        // logarithm of a level

double square(double value) noexcept {
  return value * value;
}

}  // namespace

void SlipEvidence::reset() noexcept {
  for (auto& level : log_level_) level.fill(kUnknown);
  largest_ = {};
  seen_ = {};
  since_ = 1e9;
  log_vibration_ = std::log(std::max(1.0, kFloor.white / params_.accelerometer));
  last_force_ = {};
  force_age_ = 0;
  reasons_ = 0;
  level_ = 0;
  restart();
}

void SlipEvidence::restart() noexcept {
  count_ = 0;
  time_ = forward_ = sideways_ = path_ = 0;
  e_ = {};
  learned_at_ = {};
  corrected_ = false;
}

void SlipEvidence::step(const Sample& s) noexcept {
  corrected_ = false;
  since_ += s.dt;
  if (!s.inertial) return restart();
  follow_vibration(s);
  time_ += s.dt;
  const double turn = s.rate * s.dt;
  const double along = s.force[0] - Tilt::kGravity * s.up[0] + square(s.rate) * params_.ahead;
  const double across = s.force[1] - Tilt::kGravity * s.up[1] - s.rate * (s.speed - s.rate * params_.aside);
  forward_ += along * s.dt;
  sideways_ += across * s.dt;
  const double inertial = forward_ * s.dt + params_.aside * turn;  // of the middle of the wheels
  e_[0] += s.left - inertial + params_.half_base * turn;
  e_[1] += s.right - inertial - params_.half_base * turn;
  e_[2] += params_.ahead * turn - sideways_ * s.dt;
  path_ += std::abs(s.speed) * s.dt;
  const double last = count_ == 0 ? -1 : points_[(count_ - 1) % kPoints].time;
  if (!s.read || time_ - last < kGrid) return;
  points_[count_++ % kPoints] = {.time = time_, .e = e_, .path = path_};
  judge();
}

double SlipEvidence::vibration() const noexcept {
  return std::exp(log_vibration_);
}

void SlipEvidence::follow_vibration(const Sample& s) noexcept {
  constexpr double kMedian = 0.6745;  // deviations, of |normal|
  constexpr double kVibrationStep = 0.05;
  constexpr double kMoves = 0.02;  // m/s
  force_age_ += s.dt;
  if (s.force == last_force_) return;
  const double along = s.force[0] - last_force_[0];
  const double across = s.force[1] - last_force_[1];
  if (std::abs(s.speed) > kMoves) {
    const double usual = kMedian * params_.accelerometer * std::exp(log_vibration_) * std::sqrt(2 / force_age_);
    for (const double change : {along, across})
      log_vibration_ += std::abs(change) > usual ? kVibrationStep : -kVibrationStep;
    log_vibration_ = std::max(0.0, log_vibration_);
  }
  last_force_ = s.force;
  force_age_ = 0;
}

const SlipEvidence::Point& SlipEvidence::point_before(double time) const noexcept {
  const std::size_t oldest = count_ > kPoints ? count_ - kPoints : 0;
  std::size_t i = count_ - 1;
  while (i > oldest && points_[i % kPoints].time > time) --i;
  return points_[i % kPoints];
}

SlipEvidence::Second SlipEvidence::second_difference(double span) const noexcept {
  const Point& last = points_[(count_ - 1) % kPoints];
  const Point& middle = point_before(last.time - 0.9 * span);
  const double late = last.time - middle.time;
  const Point& first = point_before(middle.time - 0.9 * late);
  const double early = middle.time - first.time;
  Second second;
  second.known = late > 0.8 * span && late < 1.6 * span && early > 0.8 * late && early < 1.6 * late;
  if (!second.known) return second;
  second.span = late;
  second.path = last.path - first.path;
  for (std::size_t c = 0; c < kChannels; ++c) {
    second.d[c] = last.e[c] - middle.e[c] - (middle.e[c] - first.e[c]) * late / early;
  }
  return second;
}

double SlipEvidence::deviation(double span, double path, const Noise& noise) const noexcept {
  const double speed = path / (2 * span);
  return std::sqrt(6 * square(params_.encoder) + square(noise.white) * span * span * span * 2 / 3 +
                   square(noise.slow * span * span) + 2 * square(kSlip) * path + 6 * square(noise.jitter * speed));
}

double SlipEvidence::expected(std::size_t span, std::size_t channel, const Second& second) const noexcept {
  const double best = deviation(second.span, second.path, {.white = params_.accelerometer, .slow = kSlow, .jitter = 0});
  const double level = log_level_[span][channel];
  return level == kUnknown ? std::max(best, deviation(second.span, second.path, kFloor)) : std::exp(level) * best;
}

void SlipEvidence::judge() noexcept {
  std::array<Second, kSpans.size()> seconds;
  for (std::size_t i = 0; i < kSpans.size(); ++i) seconds[i] = second_difference(kSpans[i]);
  for (std::size_t c = 0; c < kChannels; ++c) {
    const auto exceeds = [&](std::size_t i, double deviations) {
      return seconds[i].known && std::abs(seconds[i].d[c]) > deviations * expected(i, c, seconds[i]);
    };
    for (std::size_t i = 0; i + 1 < kSpans.size(); ++i) {
      if (exceeds(i, kProof) && exceeds(i + 1, kSeconded)) prove(c);
    }
  }
  for (std::size_t i = 0; i < kSpans.size(); ++i) {
    const Second& second = seconds[i];
    if (second.known && second.path > 0.01 * second.span && time_ - learned_at_[i] >= second.span) learn(i, second);
  }
  if (seconds[kTiltSpan].known) correct_tilt(seconds[kTiltSpan]);
  const auto level = [&](std::size_t c) { return log_level_[kLevelSpan][c]; };
  level_ = level(0) == kUnknown ? 0 : std::exp(std::max(level(0), level(1)));
}

void SlipEvidence::prove(std::size_t channel) noexcept {
  if (since_ > kLasts) reasons_ = 0;
  since_ = 0;
  constexpr std::uint64_t kReasons[kChannels] = {kSlipLeft, kSlipRight, kSlipSideways};
  reasons_ |= kReasons[channel];
}

void SlipEvidence::learn(std::size_t span, const Second& second) noexcept {
  learned_at_[span] = time_;
  const std::uint64_t seen = ++seen_[span];
  const double best = deviation(second.span, second.path, {.white = params_.accelerometer, .slow = kSlow, .jitter = 0});
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double ratio = std::abs(second.d[c]) / best / kNormal90;
    double& largest = largest_[span][c];
    double& level = log_level_[span][c];
    if (seen <= kFirst) largest = std::max(largest, ratio);
    if (seen == kFirst) level = std::log(std::max(1.0, largest));
    if (seen <= kFirst) continue;
    level = std::max(0.0, level + (ratio > std::exp(level) ? 0.9 * kStep : -0.1 * kStep));
  }
}

/// A tilt that is wrong makes an acceleration: −D/T². Bounded by what is usual, or a slide would be taken for a slope.
void SlipEvidence::correct_tilt(const Second& second) noexcept {
  const double squared = square(second.span);
  const auto bounded = [&](double d, std::size_t channel) {
    const double usual = expected(kTiltSpan, channel, second);
    return std::clamp(d, -2 * usual, 2 * usual) / squared;
  };
  corrected_ = true;
  along_ = -(bounded(second.d[0], 0) + bounded(second.d[1], 1)) / 2;
  across_ = -bounded(second.d[kSideways], kSideways);
  const std::size_t before = count_ >= 2 ? (count_ - 2) % kPoints : 0;
  interval_ = std::min(0.2, time_ - points_[before].time);
}

}  // namespace robot_control
