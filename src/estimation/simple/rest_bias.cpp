#include "estimation/simple/rest_bias.h"

#include <algorithm>

namespace robot_control {
namespace {

double largest_difference(const Vector3& a, const Vector3& b) noexcept {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

}  // namespace

void RestBias::reset(const Vector3& bias) noexcept {
  *this = RestBias(params_, bias);
}

void RestBias::Mean::add(const std::optional<Vector3>& value, double dt) noexcept {
  if (!value) return;
  time += dt;
  for (std::size_t i = 0; i < 3; ++i) sum[i] += (*value)[i] * dt;
}

std::optional<Vector3> RestBias::Mean::over(double window) const noexcept {
  if (time < window / 2) return std::nullopt;
  return Vector3{sum[0] / time, sum[1] / time, sum[2] / time};
}

void RestBias::begin_window() noexcept {
  time_ = left_ = right_ = 0;
  gyro_ = {};
  accelerometer_ = {};
}

void RestBias::step(const Sample& sample) noexcept {
  ended_ = false;
  left_ += sample.left;
  right_ += sample.right;
  variance_ += params_.walk * params_.walk * sample.dt;
  if (std::abs(left_) > params_.tolerance || std::abs(right_) > params_.tolerance) {
    quiet_ = different_ = 0;
    moved_ = true;
    return begin_window();
  }
  time_ += sample.dt;
  gyro_.add(sample.gyro, sample.dt);
  accelerometer_.add(sample.accelerometer, sample.dt);
  if (time_ >= kWindow) close();
}

void RestBias::close() noexcept {
  constexpr double kSigmas = 4;
  force_ = accelerometer_.over(time_);
  const std::optional<Vector3> mean = gyro_.over(time_);
  if (!mean) {  // no gyro: the wheels alone say that it rests
    ended_ = ++quiet_ >= 2;
    turned_ = 0;
  } else {
    const double steady = params_.steady + kSigmas * params_.noise * std::sqrt(2 / kWindow);
    const bool same = quiet_ == 0 || largest_difference(*mean, before_) <= steady;
    quiet_ = same && std::abs((*mean)[2]) < kLargest ? quiet_ + 1 : 0;
    if (quiet_ == 2 && !moved_) learn(before_);  // a run that begins at rest
    if (quiet_ >= 2) learn(*mean);
    before_ = *mean;
  }
  begin_window();
}

void RestBias::learn(const Vector3& mean) noexcept {
  constexpr double kSigmas = 5;
  const double noise = params_.noise * params_.noise / kWindow;
  if (std::abs(mean[2] - bias_[2]) > params_.steady + kSigmas * std::sqrt(variance_ + noise)) {
    if (++different_ < kReopened) return;
    variance_ += (mean[2] - bias_[2]) * (mean[2] - bias_[2]);
  }
  different_ = 0;
  ended_ = true;
  turned_ = (mean[2] - bias_[2]) * kWindow;
  const double gain = variance_ / (variance_ + noise);
  for (std::size_t i = 0; i < 3; ++i) bias_[i] += gain * (mean[i] - bias_[i]);
  variance_ = std::max((1 - gain) * variance_, kInstability * kInstability);
  learned_ = true;
}

}  // namespace robot_control
