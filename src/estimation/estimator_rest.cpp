// The estimator at rest: nothing is integrated, biases and tilt are learned.

#include <cmath>
#include <cstdint>
#include <utility>

#include "estimation/estimator.h"
#include "estimation/values.h"

namespace robot_control {

RestWindow Estimator::watch_rest(double dt) noexcept {
  RestWatch::Sample sample{.dt = dt, .left = wheels_.left(), .right = wheels_.right()};
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
  if (!core_.bias_known() && !bias_measured_ && moved_) {
    const double deviation = std::sqrt(2 * noise);
    return watch_.step(sample, {.deviation = {deviation, deviation, deviation}, .known = false});
  }
  const Vector3 deviation = array((gyro_bias_variance().array() + noise).sqrt());
  return watch_.step(sample, {.value = array(gyro_bias()), .deviation = deviation});
}

void Estimator::rest(double dt) noexcept {
  std::array<double, 2> acceleration{};
  if (imu_.accelerometer()) acceleration = tilt_.acceleration(array(*imu_.accelerometer()));
  open_window_.step(dt, wheels_.left(), wheels_.right(), imu_.gyro(), {acceleration[0], acceleration[1]});
  if (wheels_.both_fell_silent()) {  // No sensor confirms that the robot still rests.
    watch_.reset();
    lasting_flags_ &= ~std::uint64_t{kStateStandstill};
    return;
  }
  const RestWindow window = watch_rest(dt);
  if (window == RestWindow::kOpen) return;
  if (window != RestWindow::kQuiet) return end_rest();
  learn_at_rest();
  flags_ |= kStateStandstill;
  last_window_ = std::exchange(open_window_, {});
}

void Estimator::begin_rest() noexcept {
  resting_ = true;
  gyro_noise_.interrupt();
  open_window_ = last_window_ = {};
  slide_.end();
  core_.end_contradiction();
  comparison_ = {};
  wheels_.forget_turn();
  flags_ |= kStateStandstill;
  lasting_flags_ |= kStateStandstill;
  if (watch_.bias_changed()) {
    learn_at_rest();
  } else {
    watch_.discard();
  }
}

/// Integrates the last two windows at once.
void Estimator::end_rest() noexcept {
  rested_ = rested_ || bias_measured_;
  const bool stood = (lasting_flags_ & kStateStandstill) != 0;  // A run may begin in motion.
  moved_ = true;
  resting_ = false;
  lasting_flags_ &= ~std::uint64_t{kStateStandstill};
  flags_ &= ~std::uint64_t{kStateStandstill};
  HeldMotion held = std::exchange(open_window_, {});
  held.add(std::exchange(last_window_, {}));
  const double before = core_.pose().yaw;
  if (held.gyro) {
    core_.turn_by_gyro(held.turn.z(), held.time);
    turn_tilt(held.turn / held.time, held.time);
  } else {
    core_.turn_by_wheels(held.left, held.right);
  }
  const double turned = core_.pose().yaw - before;
  uncorrected_yaw_ += turned;
  advance_path({.distance = (held.left + held.right) / 2, .turn_since = turned / 2});
  wheels_.forget_turn();
  if (stood) {
    slip_detector_.restart_at_rest(uncorrected_yaw_, tilt_.up(), rotated(held.velocity, uncorrected_yaw_));
  } else {
    slip_detector_.restart();
  }
  if (wheels_.both_received()) begin_comparison();
}

void Estimator::learn_at_rest() noexcept {
  const double window = watch_.time();
  lasting_flags_ |= kStateStandstill;
  core_.age(window);
  if (watch_.gyro()) learn_gyro_bias(*watch_.gyro(), window);
  if (watch_.force()) tilt_.rest(*watch_.force(), window);
}

/// `mean` is in rad/s, over `window` s.
void Estimator::learn_gyro_bias(const Vector3& mean, double window) noexcept {
  gyro_noise_.add(mean[2], window);
  core_.set_gyro_noise(gyro_noise_.density());
  const double noise = square(parameters_.gyro_noise) / window;
  if (watch_.bias_changed()) {
    core_.open_bias(square(mean[2] - core_.bias()));
    for (const std::size_t i : {0U, 1U}) gyro_bias_[i].variance += square(mean[i] - gyro_bias_[i].value);
  }
  core_.rest(mean[2], noise, rested_);
  const double walk = square(parameters_.gyro_bias_walk) * window;
  for (const std::size_t i : {0U, 1U}) gyro_bias_[i].measure(mean[i], noise, walk);
  bias_measured_ = true;
}

}  // namespace robot_control
