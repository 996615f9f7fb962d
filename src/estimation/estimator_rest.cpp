// The estimator while the robot stands.

#include <cmath>

#include "estimation/estimator.h"
#include "estimation/filter/algebra.h"
#include "estimation/filter/placing.h"

namespace robot_control {
namespace {

using namespace algebra;
using Eigen::Vector3d;
using Filter = ErrorStateFilter;

constexpr double kAccelerometerAtRest = 0.03;  // m/s², what a body that rocks and a motor's hum leave in a mean

}  // namespace

void Estimator::rest(double dt) noexcept {
  const double left = sides_[kLeft].encoder.travel();
  const double right = sides_[kRight].encoder.travel();
  held_.time += dt;
  held_.forward += (left + right) / 2;
  held_.wheel_turn += geometry_.turn(left, right);
  if (imu_.gyro()) {
    held_.turn += *imu_.gyro() * dt;
  } else {
    held_.gyro = false;
  }
  const auto silent = [&](int side) { return sides_[static_cast<std::size_t>(side)].encoder.gap() > 0 && lost(side); };
  if (silent(kLeft) && silent(kRight)) {  // no sensor confirms that it still rests
    standstill_.reset();
    rested_ = 0;
    lasting_flags_ &= ~std::uint64_t{kStateStandstill};
    return;
  }
  const WindowEnd window = watch_rest(dt, left, right);
  if (window == WindowEnd::kOpen) return;
  if (window == WindowEnd::kQuiet && quiet()) {
    learn_at_rest();
    flags_ |= kStateStandstill;
    held_ = {};
    return;
  }
  end_rest();
}

void Estimator::end_rest() noexcept {
  resting_ = false;
  lasting_flags_ &= ~std::uint64_t{kStateStandstill};
  flags_ &= ~std::uint64_t{kStateStandstill};
  const Vector3d turn =
      held_.gyro ? Vector3d(held_.turn - held_.time * filter_.gyro_bias) : Vector3d(0, 0, held_.wheel_turn);
  filter_.position += filter_.rotation.col(0) * held_.forward;
  filter_.turn_by(turn);
  distance_ += std::abs(held_.forward);
  auto& p = filter_.covariance;
  p(Filter::kOrientation + 2, Filter::kOrientation + 2) += square(parameters_.gyro_noise) * held_.time;
  filter_.stand(rested_ > 0 ? kRestSpeed : kUnknownSpeed);  // a run may begin in motion
  if (imu_.gyro()) {
    filter_.rock((1 + filter_.gyro_scale) * (imu_.last_gyro() - filter_.gyro_bias),
                 parameters_.gyro_noise / std::sqrt(period_));
  }
  for (const int i : {kLeft, kRight}) filter_.anchor_travel(i, sides_[static_cast<std::size_t>(i)].total);
  slip_.begin(filter_);
  held_ = {};
}

WindowEnd Estimator::watch_rest(double dt, double left, double right) noexcept {
  StandstillSample sample{.dt = dt, .left = left, .right = right, .gyro = {}, .accelerometer = {}};
  if (imu_.new_gyro()) sample.gyro = imu_.last_gyro();
  if (imu_.new_accelerometer()) sample.accelerometer = imu_.last_accelerometer();
  return standstill_.step(sample);
}

Vector3d Estimator::gyro_at_rest() const noexcept {
  const double turned = geometry_.turn(standstill_.left(), standstill_.right()) / standstill_.time();
  return *standstill_.gyro() - Vector3d(0, 0, turned);
}

bool Estimator::quiet() const noexcept {
  if (!standstill_.gyro()) return true;
  const double noise = square(parameters_.gyro_noise) / standstill_.time();
  const Vector3d rate = gyro_at_rest() - filter_.gyro_bias;
  for (int i = 0; i < 3; ++i) {
    const double bias = filter_.covariance(Filter::kGyroBias + i, Filter::kGyroBias + i);
    if (std::abs(rate[i]) > parameters_.standstill_speed + 3 * std::sqrt(bias + noise)) return false;
  }
  return true;
}

bool Estimator::bias_changed() noexcept {
  const Vector3d& gyro = *standstill_.gyro();
  if (steady_time_ == 0 || (gyro - steady_gyro_).cwiseAbs().maxCoeff() > parameters_.standstill_speed) {
    steady_time_ = 0;
    steady_gyro_ = gyro;
  }
  steady_time_ += standstill_.time();
  if (steady_time_ < kSteadyTime) return false;
  steady_time_ = 0;
  for (int i = 0; i < 3; ++i) {
    const int index = Filter::kGyroBias + i;
    filter_.covariance(index, index) += square(gyro[i] - filter_.gyro_bias[i]);
  }
  return true;
}

void Estimator::learn_at_rest() noexcept {
  const double window = standstill_.time();
  rested_ += window;
  const Filter::Rest rest = rested_ <= kSettling ? Filter::Rest::kBegins : Filter::Rest::kGoesOn;
  lasting_flags_ |= kStateStandstill;
  filter_.age(window);
  if (standstill_.gyro()) {
    const Vector3d gyro = gyro_at_rest();
    for (int i = 0; i < 3; ++i) {
      filter_.correct_gyro_at_rest(i, gyro[i], square(parameters_.gyro_noise) / window, rest);
    }
  }
  if (standstill_.accelerometer()) {
    const double variance = square(parameters_.accelerometer_noise) / window + square(kAccelerometerAtRest);
    for (int i = 0; i < 3; ++i) {
      filter_.correct_accelerometer_at_rest(i, (*standstill_.accelerometer())[i], variance);
    }
  }
}

}  // namespace robot_control
