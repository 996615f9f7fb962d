// The estimator at rest: nothing is integrated, biases and tilt are learned.

#include <cmath>
#include <cstdint>
#include <utility>

#include "estimation/estimator.h"
#include "estimation/values.h"

namespace robot_control {
namespace {

constexpr double kQuietAcceleration = 0.1;  // m/s², mean at rest beside what is expected: sliding slower is no slide
constexpr std::uint64_t kDistrustedWindows = 6;  // then the tilt was wrong, not the window

}  // namespace

RestWindow Estimator::watch_rest(double dt) noexcept {
  RestWatch::Sample sample{.dt = dt, .left = sides_[kLeft].encoder.travel(), .right = sides_[kRight].encoder.travel()};
  Vector3 gyro;
  Vector3 force;
  if (imu_.gyro()) {
    gyro = array(*imu_.gyro());
    sample.gyro = &gyro;
  }
  if (imu_.accelerometer()) {
    force = array(*imu_.accelerometer());
    sample.accelerometer = &force;
  }
  const double noise = square(gyro_noise_.density()) / parameters_.standstill_time;
  const Vector3 bias{gyro_bias_[0], gyro_bias_[1], core_.bias()};
  const Vector3 deviation{std::sqrt(gyro_variance_[0] + noise), std::sqrt(gyro_variance_[1] + noise),
                          std::sqrt(core_.bias_variance() + noise)};
  return watch_.step(sample, bias, deviation);
}

void Estimator::rest(double dt) noexcept {
  held_.time += dt;
  held_.left += sides_[kLeft].encoder.travel();
  held_.right += sides_[kRight].encoder.travel();
  if (imu_.gyro()) {
    for (int i = 0; i < 3; ++i) held_.turn[static_cast<std::size_t>(i)] += (*imu_.gyro())[i] * dt;
  } else {
    held_.gyro = false;
  }
  const auto silent = [&](std::size_t side) { return sides_[side].encoder.gap() > 0 && lost(side); };
  if (silent(kLeft) && silent(kRight)) {  // no sensor confirms that it still rests
    watch_.reset();
    lasting_flags_ &= ~std::uint64_t{kStateStandstill};
    return;
  }
  const RestWindow window = watch_rest(dt);
  if (window == RestWindow::kOpen) return;
  if (window != RestWindow::kQuiet) return end_rest();
  learn_at_rest();
  flags_ |= kStateStandstill;
  kept_ = std::exchange(held_, {});
}

void Estimator::begin_rest() noexcept {
  resting_ = true;
  gyro_noise_.interrupt();
  held_ = kept_ = {};
  slide_.end();
  block_ = {};
  for (Side& side : sides_) side.turned = 0;
  flags_ |= kStateStandstill;
  lasting_flags_ |= kStateStandstill;
  distrusted_windows_ = 0;
  if (watch_.reopened()) {
    learn_at_rest();
  } else {
    watch_.discard();
  }
}

void Estimator::end_rest() noexcept {
  rested_once_ = rested_once_ || gyro_learned_;
  moved_ = true;
  resting_ = false;
  lasting_flags_ &= ~std::uint64_t{kStateStandstill};
  flags_ &= ~std::uint64_t{kStateStandstill};
  const double before = core_.pose().yaw;
  const bool stood = kept_.time > 0;
  held_.add(kept_);
  if (held_.gyro) {
    core_.turn_by_gyro(held_.turn[2], held_.time);
    turn_tilt({held_.turn[0] / held_.time, held_.turn[1] / held_.time, held_.turn[2] / held_.time}, held_.time);
  } else {
    core_.turn_by_wheels(held_.left, held_.right);
  }
  const double turned = core_.pose().yaw - before;
  own_yaw_ += turned;
  go({.distance = (held_.left + held_.right) / 2, .before = turned / 2});
  for (Side& side : sides_) side.turned = 0;
  if (stood) {
    slip_.stand(own_yaw_, tilt_.up());
  } else {
    slip_.restart();  // a run may begin in motion
  }
  if (both_read()) {
    core_.begin_block(rate_.rate().z());
    block_ = {.open = true};
  }
  held_ = kept_ = {};
}

void Estimator::learn_at_rest() noexcept {
  const double window = watch_.time();
  lasting_flags_ |= kStateStandstill;
  core_.age(window);
  if (watch_.gyro()) {
    if (!rested_once_ && !moved_) core_.replace_bias();
    core_.hold_corrections(false);
    gyro_noise_.add((*watch_.gyro())[2], window);
    core_.set_gyro_noise(gyro_noise_.density());
    const double variance = square(parameters_.gyro_noise) / window;
    if (watch_.reopened()) {
      core_.open_bias(square((*watch_.gyro())[2] - core_.bias()));
      for (const std::size_t i : {0U, 1U}) gyro_variance_[i] += square((*watch_.gyro())[i] - gyro_bias_[i]);
    }
    core_.rest((*watch_.gyro())[2], variance, rested_once_);
    for (const std::size_t i : {0U, 1U}) {
      gyro_variance_[i] += square(parameters_.gyro_bias_walk) * window;
      const double gain = gyro_variance_[i] / (gyro_variance_[i] + variance);
      gyro_bias_[i] += gain * ((*watch_.gyro())[i] - gyro_bias_[i]);
      gyro_variance_[i] *= 1 - gain;
    }
    gyro_learned_ = true;
  }
  if (watch_.force()) tilt_.rest(*watch_.force(), window);
}

/// Wheels stand, and the accelerometer reads another force than a robot at rest would.
bool Estimator::slides_at_rest() noexcept {
  if (!watch_.last_force()) return false;
  const auto acceleration = tilt_.acceleration(*watch_.last_force());
  bool slides = false;
  for (const std::size_t axis : {0U, 1U}) {
    const double doubt = std::sqrt(tilt_.acceleration_variance(axis));
    slides = slides || std::abs(acceleration[axis]) > kQuietAcceleration + 3 * doubt;
  }
  if (!slides) distrusted_windows_ = 0;
  return slides && ++distrusted_windows_ < kDistrustedWindows;
}

}  // namespace robot_control
