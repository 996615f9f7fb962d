#include "estimation/wheeled/slip/slip_watch.h"

#include <algorithm>
#include <cmath>

#include "signals/state_frame.h"

namespace robot_control {

void SlipWatch::restart() noexcept {
  count_ = 0;
  now_ = {};
  velocity_ = inertial_ = {};
  compared_at_ = 0;
  reasons_ = 0;
  slips_ = false;
  nis_ = -1;
  pending_ = 0;
}

void SlipWatch::restart_at_rest(double speed) noexcept {
  restart();
  velocity_.x = speed;
  while (count_ < kPoints) {
    Record& past = record(count_++);
    past = {};
    past.time = -static_cast<double>(kPoints - count_) * Tuning::kPointInterval;
  }
}

bool SlipWatch::step(const Sample& sample) noexcept {
  const double dt = sample.dt, squared = square(sample.yaw_rate);
  const Planar acceleration{sample.acceleration[0] + squared * params_.imu_x,
                            sample.acceleration[1] + squared * params_.imu_y - sample.yaw_rate * sample.speed};
  const Planar levers = Planar{params_.imu_y, -params_.imu_x} * sample.yaw_rate;
  inertial_ = inertial_ + (velocity_ + acceleration * dt / 2 + levers) * dt;
  velocity_ = velocity_ + acceleration * dt;
  now_.time += dt;
  now_.way += sample.travel;
  now_.distance += std::abs(sample.travel);
  now_.difference =
      Planar{now_.way + sample.clock_offset * sample.speed - params_.imu_above_ground * sample.up_x, 0} - inertial_;
  now_.speed = velocity_.x;
  wheels_ = sample.speed;
  const bool early = count_ > 0 && now_.time - record(count_ - 1).time < Tuning::kPointInterval * (1 - 1e-9);
  if (!sample.both_sides_read || early) return false;
  record(count_++) = now_;
  return true;
}

const SlipWatch::Record& SlipWatch::before(double time) const noexcept {
  std::size_t i = count_ - 1;
  while (i > 0 && i + kPoints > count_ && record(i).time > time + 1e-9) --i;
  return record(i);
}

double SlipWatch::evaluate(const Uncertainty& uncertainty, bool names) noexcept {
  gravity_error_ = {};
  const Record& end = record(count_ - 1);
  const Record& middle = before(end.time - 0.9 * Tuning::kSlipSpan);
  const double late = end.time - middle.time;
  const Record& first = before(middle.time - 0.9 * late);
  const double early = middle.time - first.time, span = Tuning::kSlipSpan;
  if (!(late > 0.8 * span && late < 1.6 * span && early > 0.8 * late && early < 1.6 * late)) return 0;
  const Planar residual = end.difference - middle.difference - (middle.difference - first.difference) * (late / early);
  const double rolled = end.distance - first.distance, change = end.speed - first.speed;
  const double shared = std::min({rolled / late, std::abs(change), std::abs(change + residual.x * 2 / late)});
  const double alone = 6 * square(params_.encoder) + square(params_.accelerometer) * late * late * late * 2 / 3 +
                       square(Tuning::kSlowAcceleration * late * late) + 2 * square(Tuning::kPathSlip) * rolled +
                       square(uncertainty.speed_step) * (square(late) + 3 * square(uncertainty.offset)) / 6;
  const double level = compared_ < Tuning::kFirstResiduals ? Tuning::kFirstLevel : std::max(level_, mean_level_);
  const double usual = std::sqrt(alone + uncertainty.gravity_variance * square(late * late));
  const double late_stamps = uncertainty.clock_offset * shared;
  const double deviation = std::hypot(level * usual, late_stamps);
  const double ratio = std::abs(residual.x) / std::hypot(usual, late_stamps) / Tuning::kNormal90;
  const double slow = std::hypot(level * Tuning::kSlowAcceleration, std::sqrt(uncertainty.gravity_variance));
  nis_ = square(residual.x / deviation);
  if (slips_ || (names && nis_ > square(Tuning::kProof))) return slide(first, middle, deviation / late, slow, ratio);
  const double interval = end.time - compared_at_;
  if (std::max(nis_, square(residual.y / deviation)) > square(Tuning::kProof)) return 0;
  if (interval < span || rolled < Tuning::kSlowestComparison * late) return 0;
  compared_at_ = end.time;
  gravity_error_ = {-residual.x / square(late), -residual.y / square(late), level * std::sqrt(alone) / square(late),
                    interval};
  learn();
  pending_ = ratio;
  return 0;
}

void SlipWatch::learn() noexcept {
  if (pending_ <= 0) return;
  const double changed = level_ * std::exp((pending_ > level_ ? 0.9 : -0.1) * Tuning::kQuantileStep);
  level_ = std::max(1.0, ++compared_ <= Tuning::kFirstResiduals ? std::max(level_, pending_) : changed);
  mean_level_ += (compared_ <= Tuning::kFirstResiduals ? 1 : Tuning::kForgetting) * (level_ - mean_level_);
  pending_ = 0;
}

double SlipWatch::slide(const Record& first, const Record& middle, double deviation, double slow,
                        double ratio) noexcept {
  const Record& end = record(count_ - 1);
  if (!slips_) {
    slips_ = true;
    line_ = (middle.difference.x - first.difference.x) / (middle.time - first.time);
    line_deviation_ = deviation;
    onset_ = counted_ = middle.time;
    slipped_ = end.time;
    sudden_ = blocked_ = path_deviation_ = 0;
    pending_ = ratio;
  }
  const Record& earlier = before(end.time - 2 * Tuning::kPointInterval * (1 - 1e-9));
  const double excess = (end.difference.x - earlier.difference.x) / (end.time - earlier.time) - line_;
  const double sigma = std::hypot(line_deviation_, slow * (end.time - onset_));
  if (std::abs(excess) > Tuning::kSignificantTurn * sigma) sudden_ = std::max(sudden_, std::abs(excess));
  const double carried = std::max(Tuning::kMinSlipSpeed, Tuning::kSignificant * sigma);
  if (std::abs(excess) > (sudden_ > 0 ? std::min(carried, sudden_ / 2) : carried)) slipped_ = end.time;
  const double ground = wheels_ - excess, dt = end.time - counted_;
  counted_ = end.time;
  const bool turns = std::abs(wheels_) > Tuning::kMinSlipSpeed;
  blocked_ = turns && std::abs(ground) <= std::min(carried, std::abs(wheels_) / 2) ? blocked_ + dt : 0;
  reasons_ = std::abs(wheels_) > std::abs(ground) ? kSlipSpinning : kSlipStalled;
  if (blocked_ >= Tuning::kBlock) {
    reasons_ |= kSlipBlocked;
    pending_ = 0;
  }
  speed_deviation_ = Tuning::kChoiceDeviation * std::abs(excess);
  const double grown = path_deviation_ + speed_deviation_ * dt;
  const double variance = square(grown) - square(path_deviation_);
  path_deviation_ = grown;
  const bool drifts = blocked_ == 0 && end.time - onset_ > Tuning::kSlipSpan + Tuning::kBlock;
  if (!drifts && end.time - slipped_ < Tuning::kSlipSpan / 2) return variance;
  learn();
  restart();
  return variance;
}

}  // namespace robot_control
