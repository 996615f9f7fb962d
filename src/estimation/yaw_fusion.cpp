#include "estimation/yaw_fusion.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

double square(double value) noexcept {
  return value * value;
}

}  // namespace

void YawFusion::reset() noexcept {
  *this = YawFusion(parameters_);
}

double YawFusion::confidence() const noexcept {
  return std::exp(-nis_ / 2);
}

void YawFusion::step(const YawSources& sources) noexcept {
  const double dt = sources.dt;
  const double smoothing = dt / (kSmoothing + dt);
  const double slip_density = square(parameters_.wheel_slip_noise / parameters_.wheel_base);  // rad²/m
  speed_ += dt / (kSpeedSmoothing + dt) * (sources.travel / dt - speed_);
  wheel_variance_ = slip_density * sources.travel;
  if (!sources.gyro) {
    innovation_ = 0;
    nis_ = 0;
    gain_ = 0;
    gyro_variance_ = 0;
    turn_ = sources.turn_wheels;
    return;
  }

  double wheel_density = slip_density * speed_;
  const double white_density =
      square(parameters_.gyro_noise) + square(parameters_.gyro_turn_noise) * std::abs(sources.turn_gyro) / dt;
  const double gyro_density = white_density + sources.bias_variance * kBiasHorizon + sources.gap_variance / dt;
  innovation_ += smoothing * ((sources.turn_gyro - sources.turn_wheels) / dt - innovation_);
  const double expected = (wheel_density + white_density + sources.gap_variance / dt) / (2 * kSmoothing) +
                          sources.bias_variance + square(parameters_.rate_floor);
  nis_ = square(innovation_) / expected;
  if (slip()) {
    const double explained = 2 * kSmoothing * square(innovation_);
    wheel_density = std::max(wheel_density, explained);
    wheel_variance_ = std::max(wheel_variance_, explained * dt);
  }
  gyro_variance_ = white_density * dt + sources.gap_variance;
  const bool still = sources.standing || wheel_density <= 0;
  gain_ = still ? 0 : wheel_density / (wheel_density + gyro_density);
  turn_ = sources.turn_wheels + gain_ * (sources.turn_gyro - sources.turn_wheels);
}

}  // namespace robot_control
