#include "estimation/planar/planar_core.h"

#include <utility>

namespace robot_control {

PlanarCore::PlanarCore(const PlanarCoreParams& params) noexcept
    : params_(params), noise_(params.slip_least, params.drags_wheels) {
  (*covariance_)(kOffset, kOffset) = square(params.clock_offset);
  (*covariance_)(kBias, kBias) = square(params.gyro_bias_initial);
  (*covariance_)(kRatio, kRatio) = square(params.ratio_deviation);
  (*covariance_)(kBase, kBase) = square(params.wheel_base_deviation);
  (*covariance_)(kScale, kScale) = square(params.gyro_scale);
  (*covariance_)(kIcr, kIcr) = square(params.icr_deviation);
  (*covariance_)(kRadius, kRadius) = square(params.radius_deviation);
}

void PlanarCore::forget(int first, int count) noexcept {
  (*covariance_).middleRows(first, count).setZero();
  (*covariance_).middleCols(first, count).setZero();
  (*held_).segment(first, count).setZero();
  (*by_bias_).segment(first, count).setZero();
}

void PlanarCore::place(const PlanarPose& pose) noexcept {
  forget(kX, 4);
  (*state_).segment<4>(kX) << pose.x, pose.y, pose.yaw, pose.yaw;
}

void PlanarCore::set_bias(double bias, double deviation) noexcept {
  forget(kBias, 1);
  (*by_bias_)[kBias] = 1;
  (*state_)[kBias] = bias;
  (*covariance_)(kBias, kBias) = square(deviation);
}

void PlanarCore::set_calibration(const WheelCalibration& known) noexcept {
  forget(kRatio, 2);
  (*state_)[kRatio] = known.radius_ratio - 1;
  (*state_)[kBase] = known.wheel_base_factor - 1;
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
  (*by_bias_)[to] += factor * (*by_bias_)[from];
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
  (*covariance_)(kYaw, kYaw) += square(params_.gyro_noise) * dt;
}

double PlanarCore::wheel_turn(double left, double right) const noexcept {
  return (right - left + ratio() * (left + right) / 2) / (params_.wheel_base * (1 + base()));
}

void PlanarCore::turn_by_wheels(double left, double right) noexcept {
  const double turned = wheel_turn(left, right);
  (*state_)[kYaw] += turned;
  add(kYaw, (left + right) / 2 / params_.wheel_base, kRatio);
  add(kYaw, -turned, kBase);
  slide(turned);
  add_yaw_variance(square(slip() / params_.wheel_base) * (std::abs(left) + std::abs(right)) +
                   square(noise_.twist()) * std::abs(turned));
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
  (*state_)[kAnchor] = (*state_)[kYaw];
  (*held_)[kAnchor] = (*held_)[kYaw];
  (*by_bias_)[kAnchor] = (*by_bias_)[kYaw];
  (*covariance_).row(kAnchor) = (*covariance_).row(kYaw);
  (*covariance_).col(kAnchor) = (*covariance_).col(kYaw);
}

PlanarCore::Innovation PlanarCore::end_block(double left, double right, double rate, double dt) noexcept {
  const double rolled = std::abs(left) + std::abs(right);
  const double mean = (left + right) / 2;
  const double later = rate - anchor_rate_;
  const double angle = turned() - offset() * later;
  const double b = params_.wheel_base * (1 + base());
  Vector h = Vector::Zero();
  h[kYaw] = b;
  h[kAnchor] = -b;
  h[kOffset] = -b * later;
  h[kRatio] = -mean;
  const double drift = square(params_.gyro_noise) * dt + (*covariance_)(kBias, kBias) * dt * dt;
  if (square(angle) > square(Tuning::kSignificantTurn) * drift) h[kBase] = params_.wheel_base * angle;
  const Vector ph = *covariance_ * h;
  const WheelNoise::Variances parts = noise_.variances(rolled, angle, b);
  const double s = h.dot(ph) + parts.slips + parts.twists + 4 * square(params_.encoder);
  const double innovation = right - left + ratio() * mean - b * angle - h.dot(*held_);
  const double normalised = innovation / std::sqrt(s);
  const bool used = std::abs(normalised) <= Tuning::kGate;
  if (used) correct(ph / s, ph, s, std::clamp(normalised, -Tuning::kHuber, Tuning::kHuber) * std::sqrt(s));
  if (!bias_known_ && !params_.drags_wheels && bias_proven()) {
    *state_ += *held_;
    (*held_).setZero();
    bias_known_ = true;
  }
  noise_.learn(normalised, parts, s);
  const double calibration = square(Tuning::kCalibrationWalk * slip());
  walk(kOffset, square(Tuning::kOffsetWalk) * dt);
  walk(kRatio, calibration * std::abs(mean));
  walk(kBase, calibration * rolled / 2);
  return {.nis = square(normalised),
          .used = used,
          .apart = innovation / b,
          .usual = Tuning::kSignificant * std::sqrt(s) / b};
}

void PlanarCore::contradict(double angle, double distance) noexcept {
  apart_ += angle;
  const double earlier = std::exchange(largest_apart_, std::max(largest_apart_, std::abs(apart_)));
  add_yaw_variance(square(largest_apart_) - square(earlier));
  shift(0, 0, square(angle * distance / 2));
}

///   P ← (I − k hᵀ) P (I − k hᵀ)ᵀ + k r kᵀ, with s = hᵀ P h + r
void PlanarCore::correct(Vector gain, const Vector& ph, double s, double innovation) noexcept {
  gain.tail<kConsidered>().setZero();
  const Vector change = innovation * gain;
  (*(bias_known_ ? state_ : held_)).segment<5>(kX) += change.segment<5>(kX);
  (*state_).segment<2>(kRatio) += change.segment<2>(kRatio);
  (*state_)[kOffset] = std::clamp((*state_)[kOffset] + change[kOffset], -Tuning::kMaxOffset, Tuning::kMaxOffset);
  const Matrix half = gain * (s / 2 * gain - ph).transpose();
  *covariance_ += half + half.transpose();
}

/// Compares an unknown bias with the bias that the path was integrated with, by their Bayes factor.
bool PlanarCore::bias_proven() const noexcept {
  const double variance = (*covariance_)(kBias, kBias);
  return square((*held_)[kBias]) > variance * std::max(1.0, std::log(square(params_.gyro_bias_initial) / variance));
}

void PlanarCore::rest(double mean, double variance, bool keeps_pose) noexcept {
  const Vector ph = (*covariance_).col(kBias);
  const double s = ph[kBias] + variance;
  Vector gain = ph / s;
  if (keeps_pose) gain.segment<4>(kX).setZero();
  const bool known = std::exchange(bias_known_, keeps_pose);
  correct(gain, ph, s, mean - bias() - (*held_)[kBias]);
  const bool integrated = !(*by_bias_).segment<4>(kX).isZero(0);
  bias_known_ = known || keeps_pose || !integrated || bias_proven();
  if (!bias_known_) return;
  const double change = std::exchange((*held_)[kBias], 0);
  (*state_)[kBias] += change;
  if (keeps_pose) return;
  const Eigen::Vector4d shift = change * (*by_bias_).segment<4>(kX);
  (*state_).segment<4>(kX) += shift;
  (*held_).segment<4>(kX) -= shift;
}

}  // namespace robot_control
