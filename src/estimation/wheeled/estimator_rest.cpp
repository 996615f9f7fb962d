// The estimator finds rests, learns the biases there and integrates the motion that was held back.

#include <optional>

#include "estimation/common/values.h"
#include "estimation/wheeled/estimator.h"

namespace robot_control {

void Estimator::watch_rest(double dt) noexcept {
  State& s = state_;
  Planar acceleration;
  if (s.imu.accelerometer) {
    const std::array<double, 2> now = s.tilt.acceleration(*s.imu.accelerometer);
    acceleration = {now[0], now[1]};
  }
  const bool bridged = !s.imu.gyro && s.imu.gyro_unchanged < Tuning::kMaxHoldTime;
  const RobotRest::Output output =
      s.rest.step({.sample = {.dt = dt,
                              .left = s.wheels.left(),
                              .right = s.wheels.right(),
                              .gyro = s.imu.gyro,
                              .accelerometer = s.imu.accelerometer},
                   .rate = bridged ? std::optional(s.imu.sample) : s.imu.gyro,
                   .acceleration = acceleration,
                   .any_lost = s.wheels.any_lost(),
                   .fell_silent = s.wheels.fell_silent,
                   .bias = array(gyro_bias()),
                   .bias_variance = array(gyro_bias_variance()),
                   .mean_variance = square(parameters_.gyro_noise) / parameters_.standstill_time});
  if (output.began) {
    s.slip.restart();
    s.comparison.interrupt();
    s.middle_travel.forget_turn();
  }
  if (output.means) learn_at_rest(*output.means, output.bias_changed);
  if (output.held) integrate(*output.held, output.was_standing);
}

/// Integrates a motion that was held back. A robot that `stood` before it began had no speed.
void Estimator::integrate(const HeldMotion& held, bool stood) noexcept {
  State& s = state_;
  const double before = s.core.pose().yaw;
  if (held.gyro) {
    s.core.turn_by_gyro(held.turn[2], held.time);
    turn_tilt(array(vector(held.turn) / held.time), held.time);
  } else {
    s.core.turn_by_wheels(held.left, held.right, 0);
  }
  roll({.distance = (held.left + held.right) / 2, .turn_since = (s.core.pose().yaw - before) / 2});
  s.middle_travel.forget_turn();
  if (stood) {
    s.slip.restart_at_rest(held.velocity.x);
  } else {
    s.slip.restart();
  }
  s.comparison.resume();
  if (!s.wheels.both_received()) return;
  s.core.begin_block(s.rate.rate().z());
  s.comparison.begin();
}

void Estimator::learn_at_rest(const RestWatch::Means& means, bool bias_changed) noexcept {
  State& s = state_;
  s.core.age(means.time);
  if (means.gyro) {
    const Vector3& mean = *means.gyro;
    const double noise = std::max(s.gyro_noise.squared(), square(parameters_.gyro_noise)) / means.time;
    const double walk = square(parameters_.gyro_bias_walk) * means.time;
    if (bias_changed) s.core.open_bias(square(mean[2] - s.core.bias()));
    s.core.rest(mean[2], noise, s.rest.rested());
    for (const std::size_t i : {0U, 1U}) {
      if (bias_changed) s.gyro_bias[i].variance += square(mean[i] - s.gyro_bias[i].value);
      s.gyro_bias[i].measure(mean[i], noise, walk);
    }
  }
  if (means.accelerometer) s.tilt.rest(*means.accelerometer, means.time);
}

}  // namespace robot_control
