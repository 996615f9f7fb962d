#include "estimation/inertial/standstill_window.h"

#include <cmath>

namespace robot_control {

void StandstillWindow::Sum::add(const Eigen::Vector3d& sample) noexcept {
  if (count == 0) origin = sample;
  ++count;
  const Eigen::Vector3d deviation = sample - origin;
  deviations += deviation;
  squares += deviation.squaredNorm();
}

double StandstillWindow::Sum::variance() const noexcept {
  if (count == 0) return 0;
  const auto n = static_cast<double>(count);
  return squares / n - (deviations / n).squaredNorm();
}

std::optional<Eigen::Vector3d> StandstillWindow::Sum::mean() const noexcept {
  if (count == 0) return std::nullopt;
  return Eigen::Vector3d(origin + deviations / static_cast<double>(count));
}

void StandstillWindow::reset() noexcept {
  time_ = left_ = right_ = 0;
  gyro_ = {};
  accelerometer_ = {};
}

WindowEnd StandstillWindow::step(const StandstillSample& sample) noexcept {
  constexpr double kRounding = 1e-9;  // s, of a sum of many dt
  left_ += sample.left;
  right_ += sample.right;
  if (std::abs(left_) > limits_.tolerance || std::abs(right_) > limits_.tolerance) {
    reset();
    return WindowEnd::kBroken;
  }
  time_ += sample.dt;
  if (sample.gyro) gyro_.add(*sample.gyro);
  if (sample.accelerometer) accelerometer_.add(*sample.accelerometer);
  if (time_ < limits_.time - kRounding) return WindowEnd::kOpen;

  const bool quiet = accelerometer_.variance() <= limits_.acceleration * limits_.acceleration;
  gyro_mean_ = gyro_.mean();
  accelerometer_mean_ = accelerometer_.mean();
  time_done_ = time_;
  left_done_ = left_;
  right_done_ = right_;
  reset();
  return quiet ? WindowEnd::kQuiet : WindowEnd::kShaken;
}

}  // namespace robot_control
