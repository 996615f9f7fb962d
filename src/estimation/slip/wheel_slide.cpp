#include "estimation/slip/wheel_slide.h"

#include <cmath>
#include <utility>

#include "signals/state_frame.h"

namespace robot_control {
namespace {

double significant(double sigma) noexcept {
  return std::max(Tuning::kMinSlipSpeed, Tuning::kSignificant * sigma);
}

}  // namespace

WheelSlide::Correction WheelSlide::begin(const MotionDifference& difference, double span, const Input& input) noexcept {
  const Point onset = difference.before(difference.last().time - 0.9 * span);
  const Point older = difference.before(onset.time - span);
  const double time = onset.time - older.time;
  if (!(time > 0)) return {};
  *this = {};
  active_ = true;
  line_ = (onset.path_difference - older.path_difference) / time;
  line_deviation_ = std::sqrt(square(input.path_slope_deviation) + square(input.noise.slow * time / 2) +
                              square(input.noise.white) * time / 3);
  onset_ = onset.time;
  onset_speed_ = rotated(onset.velocity + line_, -onset.yaw).x;
  slipped_ = difference.time();
  corrected_ = difference.before(std::max(onset.time, difference.path_begin()));
  return step(difference, input);
}

WheelSlide::Excess WheelSlide::excess(const Point& from, const Point& to) const noexcept {
  const double dt = to.time - from.time;
  const Planar off = rotated((to.path_difference - from.path_difference) / dt - line_, -(to.yaw + from.yaw) / 2);
  return {.along = off.x, .across = off.y, .turn = (to.turn_difference - from.turn_difference) / dt};
}

double WheelSlide::line_deviation(double time, const AccelerationNoise& noise) const noexcept {
  const double t = time - onset_;
  return std::sqrt(square(line_deviation_) + square(noise.slow * t) + square(noise.white) * t);
}

WheelSlide::Correction WheelSlide::step(const MotionDifference& difference, const Input& input) noexcept {
  const Point now = difference.last();
  const Point before = difference.before(now.time - 2 * Tuning::kPointInterval * (1 - 1e-9));
  if (!(now.time > before.time)) return {};
  const double deviation = line_deviation(now.time, input.noise);
  evaluate(now.time, excess(before, now), deviation, input);
  const double dt = now.time - corrected_.time;
  if (!(dt > 0)) return {};
  const double yaw = (now.yaw + corrected_.yaw) / 2;
  corrected_ = now;
  const Excess latest = excess(before, now);
  const double wheels = input.wheel_speed();
  const double ground = wheels - latest.along;
  const double stands = significant(deviation);
  const bool blocked = slips_[0] && slips_[1] && std::abs(ground) <= stands && std::abs(wheels) > stands;
  blocked_ = blocked ? blocked_ + dt : 0;
  const Planar rolled = rotated({wheels * dt, 0}, yaw);
  held_ = blocked_ > 0 && now.time > difference.path_begin() ? held_ + rolled : Planar{};
  Correction correction;
  if (blocked_ >= Tuning::kBlock) correction.shift = -std::exchange(held_, Planar{});
  excess_speed_ = blocked_ >= Tuning::kBlock ? wheels : 0;
  const double apart = sideways_ ? std::hypot(latest.along, latest.across) : latest.along;
  const auto [low, high] = std::minmax({0.0, onset_speed_, wheels});
  const double choice = Tuning::kChoiceDeviation * std::min(std::abs(apart), high - low);
  speed_deviation_ = std::max(choice, std::abs(wheels - onset_speed_) / 2);
  const double earlier = path_deviation_;
  path_deviation_ += choice * dt;
  correction.variance = square(path_deviation_) - square(earlier);
  return correction;
}

Planar WheelSlide::rolling_slope(const MotionDifference& difference) const noexcept {
  const Point now = difference.last();
  const Point before = difference.before(now.time - kRolls);
  return (now.path_difference - before.path_difference) / (now.time - before.time);
}

/// A side rolls if the slip of the other one explains its excess.
void WheelSlide::evaluate(double time, const Excess& excess, double deviation, const Input& input) noexcept {
  largest_ = std::max({largest_, std::abs(excess.side(0)), std::abs(excess.side(1))});
  const bool sudden = largest_ > Tuning::kSignificantTurn * line_deviation_;
  const double carried = significant(std::hypot(deviation, input.path_slope_deviation));
  const double tolerance = sudden ? std::min(carried, largest_ / 2) : carried;
  for (const std::size_t i : {0U, 1U}) slips_[i] = std::abs(excess.side(i)) > tolerance;
  if (!slips_[0] && !slips_[1] && std::abs(excess.turn) > significant(input.turn_slope_deviation)) {
    slips_[std::abs(excess.side(0)) > std::abs(excess.side(1)) ? 0 : 1] = true;
  }
  sideways_ = input.sideways;
  if (slips_[0] || slips_[1]) slipped_ = time;
  active_ = time - slipped_ < kRolls;
  reasons_ = 0;
  if (slips_[0]) reasons_ |= kSlipLeft;
  if (slips_[1]) reasons_ |= kSlipRight;
  if (slips_[0] != slips_[1]) reasons_ |= kSlipTurn;
  if (sideways_) reasons_ |= kSlipSideways;
  for (const std::size_t i : {0U, 1U}) {
    if (!slips_[i]) continue;
    // The wheels of this side are faster than the ground.
    const bool faster = std::abs(input.side_speed[i]) > std::abs(input.side_speed[i] - excess.side(i));
    reasons_ |= faster ? kSlipSpinning : kSlipStalled;
  }
}

}  // namespace robot_control
