#include "estimation/standstill_window.h"

#include <cmath>

namespace robot_control {

void StandstillWindow::reset() noexcept {
  standing_ = false;
  begin();
}

void StandstillWindow::begin() noexcept {
  cycles_ = 0;
  samples_ = 0;
  left_ = 0;
  right_ = 0;
  rate_sum_ = {};
  accelerations_ = 0;
  acceleration_sum_ = {};
  acceleration_squares_ = 0;
}

bool StandstillWindow::step(const StandstillSample& sample) noexcept {
  left_ += sample.left;
  right_ += sample.right;
  if (std::abs(left_) > limits_.tolerance || std::abs(right_) > limits_.tolerance) {
    reset();
    return false;
  }
  cycles_ += sample.cycles;
  ++samples_;
  for (std::size_t i = 0; i < 3; ++i) rate_sum_[i] += sample.angular_velocity[i];
  if (sample.accelerometer) {
    if (accelerations_ == 0) acceleration_origin_ = sample.linear_acceleration;
    ++accelerations_;
    for (std::size_t i = 0; i < 3; ++i) {
      const double deviation = sample.linear_acceleration[i] - acceleration_origin_[i];
      acceleration_sum_[i] += deviation;
      acceleration_squares_ += deviation * deviation;
    }
  }
  if (cycles_ < limits_.cycles) return false;

  const auto samples = static_cast<double>(samples_);
  for (std::size_t i = 0; i < 3; ++i) mean_[i] = rate_sum_[i] / samples;
  bool quiet = true;
  if (accelerations_ > 0) {
    const auto count = static_cast<double>(accelerations_);
    double variance = acceleration_squares_ / count;
    for (const double sum : acceleration_sum_) variance -= sum / count * (sum / count);
    quiet = variance <= limits_.acceleration * limits_.acceleration;
  }
  cycles_done_ = cycles_;
  left_done_ = left_;
  right_done_ = right_;
  standing_ = standing_ && quiet;
  begin();
  return quiet;
}

}  // namespace robot_control
