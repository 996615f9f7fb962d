#include "drivers/mujoco/sensors/vibration.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace robot_control {

Vibration::Vibration(std::vector<Rim> rims, const Errors& errors, double period)
    : rims_(std::move(rims)),
      period_(period),
      follow_(1 - std::exp(-2 * std::numbers::pi * kBandwidth * period)),
      gyro_(errors.roughness * errors.gyro_vibration / std::sqrt(period)),
      accelerometer_(errors.roughness * errors.accelerometer_vibration / std::sqrt(period)),
      slow_(errors.roughness * errors.accelerometer_slow_error) {}

void Vibration::reset(std::uint64_t seed) {
  vibration_stream_.seed(seed, kVibrationStream);
  slow_stream_.seed(seed, kSlowErrorStream);
  shaken_gyro_ = shaken_accelerometer_ = {};
  for (double& axis : slow_error_) axis = slow_ * slow_stream_.next();
}

void Vibration::step(Measurement& measurement) noexcept {
  if (rims_.empty()) return;  // a machine without wheels does not roll over a floor
  double speed = 0;
  for (const Rim& rim : rims_) speed += std::abs(measurement.joints[rim.joint].velocity) * rim.radius;
  speed /= static_cast<double>(rims_.size());
  const double kept = std::exp(-speed * period_ / kLength);
  const double renewed = slow_ * std::sqrt(1 - kept * kept);
  for (std::size_t axis = 0; axis < slow_error_.size(); ++axis) {
    shaken_gyro_[axis] += follow_ * (speed * gyro_ * vibration_stream_.next() - shaken_gyro_[axis]);
    double& shaken = shaken_accelerometer_[axis];
    shaken += follow_ * (speed * accelerometer_ * vibration_stream_.next() - shaken);
    slow_error_[axis] = kept * slow_error_[axis] + renewed * slow_stream_.next();
    measurement.imu.angular_velocity[axis] += shaken_gyro_[axis];
    measurement.imu.linear_acceleration[axis] += shaken + slow_error_[axis];
  }
}

}  // namespace robot_control
