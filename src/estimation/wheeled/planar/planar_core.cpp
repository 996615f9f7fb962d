#include "estimation/wheeled/planar/planar_core.h"

#include <numbers>
#include <tuple>

namespace robot_control {

PlanarCore::PlanarCore(const PlanarCoreParams& params) noexcept
    : params_(params), noise_(params.slip_least, params.drags_wheels) {
  (*covariance_)(kOffset, kOffset) = square(params.clock_offset);
  (*covariance_)(kBias, kBias) = square(params.gyro_bias_initial);
  (*covariance_)(kScale, kScale) = square(params.gyro_scale);
  (*covariance_)(kIcr, kIcr) = square(params.icr_deviation);
  (*covariance_)(kRadius, kRadius) = square(params.radius_deviation);
  set_calibration(
      {.radius_ratio_deviation = params.ratio_deviation, .wheel_base_deviation = params.wheel_base_deviation});
}

void PlanarCore::forget(int first, int count) noexcept {
  (*covariance_).middleRows(first, count).setZero();
  (*covariance_).middleCols(first, count).setZero();
  (*held_).segment(first, count).setZero();
}

void PlanarCore::place(const PlanarPose& pose) noexcept {
  forget(kX, 4);
  (*state_).segment<4>(kX) << pose.x, pose.y, pose.yaw, pose.yaw;
  (*hidden_).setZero();
  doubt_ = apart_ = 0;
  placed_x_ = pose.x;
  placed_y_ = pose.y;
}

void PlanarCore::set_bias(double bias, double deviation) noexcept {
  forget(kBias, 1);
  (*state_)[kBias] = bias;
  (*covariance_)(kBias, kBias) = square(deviation);
}

void PlanarCore::set_calibration(const WheelCalibration& known) noexcept {
  start_ = known;
  worse_ = 0;
  forget(kRatio, 2);
  (*state_).segment<2>(kRatio) << known.radius_ratio - 1, known.wheel_base_factor - 1;
  if (params_.ratio_deviation > 0) (*covariance_)(kRatio, kRatio) = square(known.radius_ratio_deviation);
  if (params_.wheel_base_deviation > 0) (*covariance_)(kBase, kBase) = square(known.wheel_base_deviation);
}

void PlanarCore::set_pose_covariance(const Eigen::Matrix3d& known) noexcept {
  (*covariance_).block<3, 3>(kX, kX) = known;
}

///   P ← T P Tᵀ, T = I + factor e_to e_fromᵀ
void PlanarCore::add(int to, double factor, int from) noexcept {
  (*covariance_).row(to) += factor * (*covariance_).row(from);
  (*covariance_).col(to) += factor * (*covariance_).col(from);
  (*held_)[to] += factor * (*held_)[from];
}

/// The middle of the wheels moves sideways if it is not the centre of rotation.
void PlanarCore::slide(double turned) noexcept {
  if (params_.icr_deviation == 0) return;
  add(kX, turned * std::sin((*state_)[kYaw]), kIcr);
  add(kY, -turned * std::cos((*state_)[kYaw]), kIcr);
}

void PlanarCore::turn_by_gyro(double angle, double dt) noexcept {
  const double turned = angle - bias() * dt;
  (*state_)[kYaw] += turned;
  age(dt);
  slide(turned);
  add(kYaw, -dt, kBias);
  add(kYaw, turned, kScale);
  add_yaw_variance(square(params_.gyro_noise) * dt);
}

double PlanarCore::wheel_turn(double left, double right) const noexcept {
  return (right - left + ratio() * (left + right) / 2) / (params_.wheel_base * (1 + base()));
}

void PlanarCore::turn_by_wheels(double left, double right, double already) noexcept {
  const double turned = wheel_turn(left, right) - already;
  (*state_)[kYaw] += turned;
  add(kYaw, (left + right) / 2 / params_.wheel_base, kRatio);
  add(kYaw, -turned, kBase);
  slide(turned);
  const double rolled = square(slip() / params_.wheel_base) * (std::abs(left) + std::abs(right));
  add_yaw_variance(square(Tuning::kUnwatched) * (rolled + square(noise_.twist()) * std::abs(turned)));
}

void PlanarCore::roll(double x, double y, double rate) noexcept {
  add(kX, -y, kYaw);
  add(kY, x, kYaw);
  add(kX, x, kRadius);
  add(kY, y, kRadius);
  add(kX, rate * y, kOffset);
  add(kY, -rate * x, kOffset);
  shift(x, y, square(slip()) / 2 * std::hypot(x, y));
}

void PlanarCore::shift(double x, double y, double variance) noexcept {
  (*state_)[kX] += x;
  (*state_)[kY] += y;
  (*covariance_)(kX, kX) += variance;
  (*covariance_)(kY, kY) += variance;
}

void PlanarCore::begin_block(double rate) noexcept {
  anchor_rate_ = rate;
  anchor_x_ = (*state_)[kX];
  anchor_y_ = (*state_)[kY];
  (*state_)[kAnchor] = (*state_)[kYaw];
  (*covariance_).row(kAnchor) = (*covariance_).row(kYaw);
  (*covariance_).col(kAnchor) = (*covariance_).col(kYaw);
  (*held_)[kAnchor] = (*held_)[kYaw];
}

PlanarCore::Innovation PlanarCore::end_block(const Block& block) noexcept {
  const double rolled = std::abs(block.left) + std::abs(block.right), mean = (block.left + block.right) / 2;
  const double later = block.rate - anchor_rate_, angle = turned() - offset() * later;
  const double b = params_.wheel_base * (1 + base()), difference = block.right - block.left;
  Vector h = Vector::Zero();
  h[kYaw] = b;
  h[kAnchor] = -b;
  h[kOffset] = -b * later;
  h[kRatio] = -mean;
  const double by_wheels = difference + ratio() * mean;
  const WheelNoise::Variances parts = noise_.variances(rolled, angle, b);
  const double drift = square(params_.gyro_noise) * block.time + bias_variance() * square(block.time);
  const double innovation = by_wheels - b * (angle + (*held_)[kYaw] - (*held_)[kAnchor]);
  const double reading = 4 * square(params_.encoder);
  const auto [turn, noise, held] = params_.drags_wheels ? std::tuple(b * angle, square(b) * drift, kHeld)
                                                        : std::tuple(by_wheels, parts.slips + reading, 0);
  if (square(turn) > square(Tuning::kSignificantTurn) * noise) h[kBase] = turn / (1 + base());
  const Vector ph = *covariance_ * h;
  const double s = h.dot(ph) + parts.slips + parts.twists + reading;
  const double normalised = innovation / std::sqrt(s);
  const bool agree = std::abs(normalised) <= Tuning::kGate;
  compare(angle, angle + innovation / b, Tuning::kSignificant * std::sqrt(s) / b, agree, block.stuck);
  if (block.slid) return {.nis = square(normalised), .used = false};
  const double widened = std::max(s, square(innovation / Tuning::kHuber));
  if (agree) correct(ph / widened, ph, widened, innovation, held);
  noise_.learn(normalised, parts, s);
  const double other =
      difference + (start_.radius_ratio - 1) * mean - params_.wheel_base * start_.wheel_base_factor * angle;
  check_calibration(innovation, other, s);
  const double calibration = square(Tuning::kCalibrationWalk * slip());
  walk(kOffset, square(Tuning::kOffsetWalk) * block.time);
  walk(kRatio, calibration * std::abs(mean));
  walk(kBase, calibration * rolled / 2);
  return {.nis = square(normalised), .used = agree};
}

/// `angle` is the turn by the gyro, `wheels` that by the wheels, `usual` their usual difference, rad.
void PlanarCore::compare(double angle, double wheels, double usual, bool agree, bool stuck) noexcept {
  if (agree && !stuck) {
    const double taken = params_.drags_wheels ? 3 * Tuning::kAgreement : Tuning::kAgreement;
    doubt_ *= 1 - taken;
    apart_ *= 1 - taken;
    return;
  }
  const double least = params_.drags_wheels && !stuck ? 0 : wheels;
  const double nearest = std::clamp(angle, std::min(least, wheels), std::max(least, wheels));
  contradict(std::copysign(std::max(0.0, std::abs(angle - nearest) - (stuck ? 0 : usual)), nearest - angle));
}

/// `learned` and `other` are the innovations of a block by the learned calibration and by that of the start, m.
void PlanarCore::check_calibration(double learned, double other, double variance) noexcept {
  const double bound = square(Tuning::kHuber) * variance;
  const double worse = (std::min(square(learned), bound) - std::min(square(other), bound)) / variance;
  worse_ = std::max(0.0, worse_ + worse);
  if (worse_ > square(Tuning::kSignificant)) set_calibration(start_);
}

void PlanarCore::contradict(double angle) noexcept {
  if (angle == 0) return;
  if (doubt_ == 0) {
    doubted_x_ = anchor_x_;
    doubted_y_ = anchor_y_;
  }
  apart_ += angle;
  doubt_ = std::max(doubt_, std::abs(apart_));
}

///   P ← (I − k hᵀ) P (I − k hᵀ)ᵀ + k r kᵀ, with s = hᵀ P h + r
/// From x on, the corrections of `held` states are not applied.
void PlanarCore::correct(Vector gain, const Vector& ph, double s, double innovation, int held) noexcept {
  gain.tail<kConsidered>().setZero();
  Vector change = innovation * gain;
  (*held_).segment(kX, held) += change.segment(kX, held);
  change.segment(kX, held).setZero();
  *state_ += change;
  *hidden_ += change.segment<3>(kX);
  (*state_)[kOffset] = std::clamp((*state_)[kOffset], -Tuning::kMaxOffset, Tuning::kMaxOffset);
  const Matrix half = gain * (s / 2 * gain - ph).transpose();
  *covariance_ += half + half.transpose();
}

void PlanarCore::apply_held(int first, int count) noexcept {
  if (first == kX) *hidden_ += (*held_).segment<3>(kX);
  (*state_).segment(first, count) += (*held_).segment(first, count);
  (*held_).segment(first, count).setZero();
}

void PlanarCore::rest(double mean, double variance, bool keeps_pose) noexcept {
  const Vector ph = (*covariance_).col(kBias);
  const double s = ph[kBias] + variance;
  correct(ph / s, ph, s, mean - bias() - (*held_)[kBias], kHeld);
  apply_held(kBias, 1);
  turned_ = turned_ || square((*held_)[kYaw]) > square(Tuning::kSignificant) * (*covariance_)(kYaw, kYaw);
  if (turned_ && !keeps_pose) apply_held(kX, kHeld - 1);
}

/// A heading that is wrong by δ since the doubt began turns the way since then by δ, so that it errs by sin δ across. A
/// heading whose whole deviation is σ shortens the way from the place where the pose was set by up to 1 − cos σ.
Eigen::Matrix4d PlanarCore::pose_covariance() const noexcept {
  const Eigen::Vector4d held = (*held_).head<4>();
  Eigen::Matrix4d covariance = (*covariance_).topLeftCorner<4, 4>() + held * held.transpose();
  covariance.bottomRightCorner<3, 3>() += *hidden_ * (*hidden_).transpose();
  const double x = (*state_)[kX], y = (*state_)[kY];
  const Eigen::Vector4d across(0, doubted_y_ - y, x - doubted_x_, 1);
  covariance += square(doubt_) * across * across.transpose();
  const Eigen::Vector4d along(0, x - placed_x_, y - placed_y_, 0);
  const double yaw = std::min(std::sqrt(covariance(kYaw, kYaw)), std::numbers::pi);
  covariance += square(1 - std::cos(yaw)) * along * along.transpose();
  return covariance;
}

}  // namespace robot_control
