#include "estimation/planar/planar_core.h"

#include <algorithm>
#include <utility>

#include "estimation/tuning.h"

namespace robot_control {

PlanarCore::PlanarCore(const PlanarCoreParams& params) noexcept
    : params_(params),
      gyro_noise_(params.gyro_noise),
      slip_(std::max(Tuning::kFirstSlip, params.slip_least)),
      twist_(Tuning::kFirstTwist) {
  covariance_[kBias][kBias] = square(params.gyro_bias_initial);
  covariance_[kScale][kScale] = square(params.gyro_scale);
  covariance_[kRatio][kRatio] = square(params.ratio_deviation);
  covariance_[kBase][kBase] = square(params.wheel_base_deviation);
  covariance_[kOffset][kOffset] = square(params.clock_offset);
  covariance_[kIcr][kIcr] = square(params.icr_deviation);
}

void PlanarCore::place(const PlanarPose& pose) noexcept {
  pose_ = pose;
  for (const std::size_t i : {kX, kY, kYaw, kAnchor}) {
    for (std::size_t k = 0; k < kSize; ++k) covariance_[i][k] = covariance_[k][i] = 0;
  }
  for (const std::size_t i : {kX, kY, kYaw, kAnchor}) held_[i] = 0;
  anchor_ = pose.yaw;
}

void PlanarCore::set_bias(double bias, double deviation) noexcept {
  bias_ = bias;
  held_[kBias] = 0;
  for (const std::size_t i : {kBias, kRestBias}) {
    for (std::size_t k = 0; k < kSize; ++k) covariance_[i][k] = covariance_[k][i] = 0;
  }
  covariance_[kBias][kBias] = square(deviation);
}

void PlanarCore::set_calibration(const WheelCalibration& known) noexcept {
  ratio_ = known.radius_ratio - 1;
  base_ = known.wheel_base_factor - 1;
  for (const std::size_t i : {kRatio, kBase}) {
    for (std::size_t k = 0; k < kSize; ++k) covariance_[i][k] = covariance_[k][i] = 0;
  }
  covariance_[kRatio][kRatio] = params_.ratio_deviation == 0 ? 0 : square(known.radius_ratio_deviation);
  covariance_[kBase][kBase] = params_.wheel_base_deviation == 0 ? 0 : square(known.wheel_base_deviation);
}

/// P ← T P Tᵀ, T = I + factor e_to e_fromᵀ.
void PlanarCore::add(std::size_t to, double factor, std::size_t from) noexcept {
  Row& row = covariance_[to];
  const Row& other = covariance_[from];
  for (std::size_t k = 0; k < kSize; ++k) row[k] += factor * other[k];
  row[to] += factor * row[from];
  for (std::size_t k = 0; k < kSize; ++k) covariance_[k][to] = row[k];
  held_[to] += factor * held_[from];
}

/// The middle of the wheels moves sideways where the centre of rotation is not there.
void PlanarCore::slide(double turned) noexcept {
  if (params_.icr_deviation == 0) return;
  add(kX, turned * std::sin(pose_.yaw), kIcr);
  add(kY, -turned * std::cos(pose_.yaw), kIcr);
}

void PlanarCore::turn_by_gyro(double angle, double dt) noexcept {
  const double turned = angle - bias_ * dt;
  pose_.yaw += turned;
  age(dt);
  slide(turned);
  add(kYaw, -dt, kBias);
  add(kYaw, -dt, kRestBias);
  add(kAnchor, -dt, kRestBias);
  add(kYaw, turned, kScale);
  covariance_[kYaw][kYaw] += square(params_.gyro_noise) * dt;
  const double beyond = (square(gyro_noise_) - square(params_.gyro_noise)) * dt;  // considered: no block sees it
  covariance_[kYaw][kYaw] += beyond;
  covariance_[kYaw][kAnchor] += beyond;
  covariance_[kAnchor][kYaw] += beyond;
  covariance_[kAnchor][kAnchor] += beyond;
}

double PlanarCore::wheel_turn(double left, double right) const noexcept {
  return (right - left + ratio_ * (left + right) / 2) / (params_.wheel_base * (1 + base_));
}

void PlanarCore::turn_by_wheels(double left, double right) noexcept {
  const double turned = wheel_turn(left, right);
  pose_.yaw += turned;
  add(kYaw, (left + right) / 2 / params_.wheel_base, kRatio);
  add(kYaw, -turned, kBase);
  slide(turned);
  covariance_[kYaw][kYaw] +=
      square(slip_ / params_.wheel_base) * (std::abs(left) + std::abs(right)) + square(twist_) * std::abs(turned);
}

void PlanarCore::roll(double x, double y, double rate) noexcept {
  pose_.x += x;
  pose_.y += y;
  add(kX, -y, kYaw);
  add(kY, x, kYaw);
  add(kX, rate * y, kOffset);
  add(kY, -rate * x, kOffset);
  const double noise = square(slip_) / 2 * std::sqrt(x * x + y * y);
  covariance_[kX][kX] += noise;
  covariance_[kY][kY] += noise;
}

void PlanarCore::shift(double x, double y, double variance) noexcept {
  pose_.x += x;
  pose_.y += y;
  covariance_[kX][kX] += variance;
  covariance_[kY][kY] += variance;
}

void PlanarCore::set_pose_covariance(const Eigen::Matrix3d& known) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) covariance_[i][j] = known(static_cast<int>(i), static_cast<int>(j));
  }
}

Eigen::Matrix4d PlanarCore::pose_and_offset_covariance() const noexcept {
  constexpr std::size_t kStates[4] = {kX, kY, kYaw, kOffset};
  Eigen::Matrix4d states;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) states(i, k) = covariance(kStates[i], kStates[k]);
  }
  return states;
}

void PlanarCore::begin_block(double rate) noexcept {
  anchor_ = pose_.yaw;
  held_[kAnchor] = held_[kYaw];
  anchor_rate_ = rate;
  covariance_[kAnchor] = covariance_[kYaw];
  covariance_[kAnchor][kAnchor] = covariance_[kYaw][kYaw];
  for (std::size_t k = 0; k < kSize; ++k) covariance_[k][kAnchor] = covariance_[kAnchor][k];
}

PlanarCore::Innovation PlanarCore::end_block(double left, double right, double rate, double dt,
                                             double jitter) noexcept {
  const double way = (left + right) / 2;
  const double later = rate - anchor_rate_;
  const double angle = turned() - offset_ * later;
  const double b = params_.wheel_base * (1 + base_);
  double innovation = right - left + ratio_ * way - b * angle;
  const double doubt = square(params_.gyro_noise) * dt + covariance_[kBias][kBias] * dt * dt;
  Row h{};
  h[kYaw] = b;
  h[kAnchor] = -b;
  h[kOffset] = -b * later;
  if (square(angle) > square(Tuning::kSignificantTurn) * doubt) h[kBase] = params_.wheel_base * angle;
  h[kRatio] = -way;
  Row ph{};
  double s = 0;
  for (std::size_t i = 0; i < kSize; ++i) innovation -= h[i] * held_[i];
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t k = 0; k < kSize; ++k) ph[i] += covariance_[i][k] * h[k];
  }
  for (std::size_t i = 0; i < kSize; ++i) s += h[i] * ph[i];
  const double rolled = std::abs(left) + std::abs(right);
  const double repeated = std::clamp(correlation_ / power_, 0.0, Tuning::kLargestCorrelation);
  const double again = (1 + repeated) / (1 - repeated);
  const double slips = square(slip_) * rolled * again;
  const double twists = square(b * twist_) * std::abs(angle) * again;
  s += 4 * square(params_.encoder) + twists + slips + b * b * jitter * (square(rate) + square(anchor_rate_));
  const double normalised = innovation / std::sqrt(s);
  const bool used = std::abs(normalised) <= Tuning::kGate;
  if (used) {
    Row gain{};
    for (std::size_t i = 0; i < kSize; ++i) gain[i] = ph[i] / s;
    gain[kScale] = gain[kRestBias] = gain[kIcr] = 0;
    if (params_.ratio_deviation == 0) gain[kRatio] = 0;
    correct(gain, ph, s, std::clamp(normalised, -Tuning::kHuber, Tuning::kHuber) * std::sqrt(s));
    if (!holds_ || square(held_[kBias]) > square(Tuning::kProvenBias) * covariance_[kBias][kBias]) release();
  }
  learn(normalised, slips / s, twists / s);
  if (params_.clock_offset > 0) covariance_[kOffset][kOffset] += square(Tuning::kOffsetWalk) * dt;
  covariance_[kRatio][kRatio] += params_.ratio_deviation == 0 ? 0 : square(Tuning::kRatioWalk * slip_) * std::abs(way);
  covariance_[kBase][kBase] += params_.wheel_base_deviation == 0 ? 0 : square(Tuning::kBaseWalk * slip_) * rolled / 2;
  return {square(normalised), used};
}

void PlanarCore::correct(const Row& gain, const Row& ph, double s, double innovation) noexcept {
  for (std::size_t i = 0; i < kSize; ++i) held_[i] += gain[i] * innovation;
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t k = 0; k < kSize; ++k) {
      covariance_[i][k] += gain[i] * gain[k] * s - gain[i] * ph[k] - ph[i] * gain[k];
    }
  }
}

/// The Bayes factor of a bias that could be any against the one that the path was driven by.
bool PlanarCore::bias_proven() const noexcept {
  const double variance =
      covariance_[kBias][kBias] + 2 * covariance_[kBias][kRestBias] + covariance_[kRestBias][kRestBias];
  return square(held_[kBias]) > variance * std::max(1.0, std::log(square(params_.gyro_bias_initial) / variance));
}

void PlanarCore::release() noexcept {
  const bool all = !bias_in_doubt_ || bias_proven();
  const Row kept = held_;
  if (all) {
    pose_.x += held_[kX];
    pose_.y += held_[kY];
    pose_.yaw += held_[kYaw];
    anchor_ += held_[kAnchor];
    bias_ += held_[kBias];
    bias_in_doubt_ = false;
  }
  ratio_ += held_[kRatio];
  base_ += held_[kBase];
  offset_ = std::clamp(offset_ + held_[kOffset], -Tuning::kLargestOffset, Tuning::kLargestOffset);
  held_ = {};
  if (all) return;
  for (const std::size_t i : {kX, kY, kYaw, kAnchor, kBias}) held_[i] = kept[i];
}

void PlanarCore::learn(double normalised, double slips, double twists) noexcept {
  const double bounded = std::clamp(normalised, -Tuning::kSignificant, Tuning::kSignificant);
  correlation_ += Tuning::kLevelMemory * (bounded * last_ - correlation_);
  power_ = std::max(0.1, power_ + Tuning::kLevelMemory * (bounded * bounded - power_));
  last_ = bounded;
  constexpr double kNormalMedian = 0.6745;  // deviations, of |normal|
  const double step = std::abs(normalised) > kNormalMedian ? Tuning::kLevelStep : -Tuning::kLevelStep;
  twist_ = std::clamp(twist_ * std::exp(step * twists), Tuning::kLeastTwist, Tuning::kLargestTwist);
  slip_ = std::clamp(slip_ * std::exp(step * slips), params_.slip_least, Tuning::kLargestSlip);
}

void PlanarCore::rest(double mean, double variance, bool holds) noexcept {
  const double s = covariance_[kBias][kBias] + variance;
  Row ph{};
  Row gain{};
  for (std::size_t i = 0; i < kSize; ++i) {
    ph[i] = covariance_[i][kBias];
    gain[i] = ph[i] / s;
  }
  gain[kScale] = gain[kRestBias] = gain[kIcr] = 0;
  if (holds) gain[kX] = gain[kY] = gain[kYaw] = gain[kAnchor] = 0;
  correct(gain, ph, s, mean - bias_ - held_[kBias]);
  const double kept = 1 - gain[kBias];
  const double beyond = variance * (square(gyro_noise_ / params_.gyro_noise) - 1);
  gain[kRestBias] = std::exchange(gain[kBias], 0);
  for (std::size_t i = 0; i < kSize; ++i) {
    if (i != kRestBias && gain[i] != 0) add(i, -gain[i], kRestBias);
  }
  for (std::size_t k = 0; k < kSize; ++k) covariance_[kRestBias][k] *= kept;
  for (std::size_t k = 0; k < kSize; ++k) covariance_[k][kRestBias] *= kept;
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t k = 0; k < kSize; ++k) covariance_[i][k] += gain[i] * gain[k] * beyond;
  }
  // Earlier windows, too, were as noisy as is known by now.
  const double most = covariance_[kBias][kBias] * (square(gyro_noise_ / params_.gyro_noise) - 1);
  double& excess = covariance_[kRestBias][kRestBias];
  const double less = excess > most ? std::sqrt(most / excess) : 1;
  for (std::size_t k = 0; k < kSize; ++k) covariance_[kRestBias][k] *= less;
  for (std::size_t k = 0; k < kSize; ++k) covariance_[k][kRestBias] *= less;
  if (!holds_) release();
}

}  // namespace robot_control
