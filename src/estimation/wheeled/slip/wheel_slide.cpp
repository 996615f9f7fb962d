#include "estimation/wheeled/slip/wheel_slide.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "signals/state_frame.h"

namespace robot_control {
namespace {

double significant(double sigma) noexcept {
  return std::max(Tuning::kMinSlipSpeed, Tuning::kSignificant * sigma);
}

}  // namespace

WheelSlide::Correction WheelSlide::begin(const SlipDetector& detector, const Speeds& treads) noexcept {
  const MotionDifference& difference = detector.difference();
  const AccelerationNoise noise = detector.acceleration_noise();
  const double span = detector.shortest_proven_span();
  const Point onset = difference.before(difference.last().time - 0.9 * span);
  const Point older = difference.before(onset.time - span);
  const double time = onset.time - older.time;
  if (!(time > 0)) return {};
  *this = {};
  active_ = true;
  line_ = (onset.path_difference - older.path_difference) / time;
  line_deviation_ = std::sqrt(square(detector.slope_deviation(SlipResidual::kAlong)) + square(noise.slow * time / 2) +
                              square(noise.white) * time / 3);
  onset_ = onset.time;
  onset_speed_ = rotated(onset.velocity + line_, -onset.yaw).x;
  slipped_ = difference.time();
  corrected_ = difference.before(std::max(onset.time, difference.path_begin()));
  return step(detector, treads);
}

WheelSlide::Correction WheelSlide::step(const SlipDetector& detector, const Speeds& treads) noexcept {
  const MotionDifference& difference = detector.difference();
  const AccelerationNoise noise = detector.acceleration_noise();
  const Point now = difference.last();
  const Point before = difference.before(now.time - 2 * Tuning::kPointInterval * (1 - 1e-9));
  const double span = now.time - before.time;
  if (!(span > 0)) return {};
  const Planar off =
      rotated((now.path_difference - before.path_difference) / span - line_, -(now.yaw + before.yaw) / 2);
  const Excess latest{off.x, off.y, (now.turn_difference - before.turn_difference) / span};
  const double t = now.time - onset_;
  const double deviation = std::sqrt(square(line_deviation_) + square(noise.slow * t) + square(noise.white) * t);
  evaluate(detector, latest, deviation, treads);
  const double dt = now.time - corrected_.time;
  if (!(dt > 0)) return {};
  const double yaw = (now.yaw + corrected_.yaw) / 2;
  corrected_ = now;
  const double wheels = (treads[0] + treads[1]) / 2;
  const double stands = significant(deviation);
  const bool stood = slips_[0] && slips_[1] && std::abs(wheels - latest.along) <= stands;
  const bool blocked = stood && (excess_speed_ != 0 || std::abs(wheels) > stands);
  Correction correction{.shift = take_back(wheels, dt, yaw, blocked, now.time <= difference.path_begin())};
  const double apart = sideways_ ? std::hypot(latest.along, latest.across) : latest.along;
  const auto [low, high] = std::minmax({0.0, onset_speed_, wheels});
  const double choice = Tuning::kChoiceDeviation * std::min(std::abs(apart), high - low);
  speed_deviation_ = std::max(choice, std::abs(wheels - onset_speed_) / 2);
  const double earlier = std::exchange(path_deviation_, path_deviation_ + choice * dt);
  correction.variance = square(path_deviation_) - square(earlier);
  return correction;
}

/// Returns the shift of a robot that is blocked. A path that `begins` now has nothing to take back.
Planar WheelSlide::take_back(double wheels, double dt, double yaw, bool blocked, bool begins) noexcept {
  blocked_ = blocked ? blocked_ + dt : 0;
  held_ = blocked && !begins ? held_ + rotated({wheels * dt, 0}, yaw) : Planar{};
  const bool known = blocked_ >= Tuning::kBlock;
  excess_speed_ = known ? wheels : 0;
  return known ? -std::exchange(held_, Planar{}) : Planar{};
}

Planar WheelSlide::rolling_slope(const MotionDifference& difference) const noexcept {
  const Point now = difference.last();
  const Point before = difference.before(now.time - kRolls);
  return (now.path_difference - before.path_difference) / (now.time - before.time);
}

/// A side rolls if the slip of the other one explains its excess.
void WheelSlide::evaluate(const SlipDetector& detector, const Excess& excess, double deviation,
                          const Speeds& treads) noexcept {
  const double larger = std::max(std::abs(excess.side(0)), std::abs(excess.side(1)));
  if (larger > Tuning::kSignificantTurn * deviation) sudden_ = std::max(sudden_, larger);
  const double carried = significant(std::hypot(deviation, detector.slope_deviation(SlipResidual::kAlong)));
  const double tolerance = sudden_ > 0 ? std::min(carried, sudden_ / 2) : carried;
  for (const std::size_t i : {0U, 1U}) slips_[i] = std::abs(excess.side(i)) > tolerance;
  const double turns = significant(detector.slope_deviation(SlipResidual::kTurn));
  if (!slips_[0] && !slips_[1] && std::abs(excess.turn) > turns) {
    slips_[std::abs(excess.side(0)) > std::abs(excess.side(1)) ? 0 : 1] = true;
  }
  sideways_ = detector.proven(SlipResidual::kAcross) || (sideways_ && std::abs(excess.across) > carried);
  const double time = detector.difference().last().time;
  if (slips_[0] || slips_[1] || sideways_) slipped_ = time;
  active_ = time - slipped_ < kRolls;
  name(excess, treads);
}

void WheelSlide::name(const Excess& excess, const Speeds& treads) noexcept {
  reasons_ = 0;
  if (slips_[0]) reasons_ |= kSlipLeft;
  if (slips_[1]) reasons_ |= kSlipRight;
  if (slips_[0] != slips_[1]) reasons_ |= kSlipTurn;
  if (sideways_) reasons_ |= kSlipSideways;
  for (const std::size_t i : {0U, 1U}) {
    if (!slips_[i]) continue;
    const bool faster = std::abs(treads[i]) > std::abs(treads[i] - excess.side(i));  // than the ground
    reasons_ |= faster ? kSlipSpinning : kSlipStalled;
  }
}

}  // namespace robot_control
