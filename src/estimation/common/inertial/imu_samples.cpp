#include "estimation/common/inertial/imu_samples.h"

#include <algorithm>
#include <utility>

#include "estimation/common/values.h"

namespace robot_control {

std::optional<Vector3> ImuSamples::Channel::step(const std::optional<Vector3>& sample, double dt,
                                                 bool trapezoid) noexcept {
  age += dt;
  catches_up = false;
  if (!sample) {
    known = known && age <= hold;
    return known ? std::optional(last) : std::nullopt;
  }
  std::optional<Vector3> mean = sample;
  if (trapezoid && known && age <= hold && dt > 0) {
    for (std::size_t i = 0; i < 3; ++i) (*mean)[i] = last[i] + ((*sample)[i] - last[i]) * (age / dt / 2);
    catches_up = age > dt;
  }
  if (received && dt > hold) mean.reset();  // One sample is no mean of such a long step.
  // The gap also counts if the sample before was lost. Otherwise a device slower than the hold would stay lost.
  if (received && age > 0) {
    gap = std::min(age, std::exchange(last_gap, age));
    hold = std::clamp(3 * age, Tuning::kMinHoldTime, Tuning::kMaxHoldTime);
  }
  last = *sample;
  received = known = true;
  age = 0;
  return mean;
}

ImuReading ImuSamples::step(const SensorFrame& sensors, const Eigen::Matrix3d& base_from_imu, double dt) noexcept {
  ImuReading reading;
  const auto sample = [&](std::uint64_t bit, const Vector3& values, double range) -> std::optional<Vector3> {
    if ((sensors.valid & bit) == 0) return std::nullopt;
    const Eigen::Vector3d in_imu = vector(values);
    const bool good = in_imu.squaredNorm() <= range * range;
    reading.refused = reading.refused || !good;
    return good ? std::optional(array(base_from_imu * in_imu)) : std::nullopt;
  };
  const auto rate = sample(kValidGyro, sensors.imu.angular_velocity, Tuning::kGyroRange);
  const auto force = sample(kValidAccelerometer, sensors.imu.linear_acceleration, Tuning::kAccelerometerRange);
  const Vector3 before = gyro_.last;
  reading.gyro = gyro_.step(rate, dt, true);
  reading.accelerometer = accelerometer_.step(force, dt, false);
  if (accelerometer_.gap > Tuning::kSlowAccelerometer) reading.accelerometer.reset();
  reading.rate = reading.gyro && !gyro_.catches_up ? *reading.gyro : gyro_.last;
  reading.sample = gyro_.last;
  reading.fresh_gyro = rate.has_value();
  reading.gyro_gap = gyro_.gap;
  gyro_unchanged_ = gyro_.last == before ? gyro_unchanged_ + dt : 0;
  reading.gyro_unchanged = gyro_unchanged_;
  return reading;
}

}  // namespace robot_control
