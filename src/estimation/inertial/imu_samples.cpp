#include "estimation/inertial/imu_samples.h"

#include <algorithm>
#include <utility>

namespace robot_control {

void ImuSamples::accept(Channel& channel, const std::optional<Eigen::Vector3d>& sample, double dt,
                        bool trapezoid) noexcept {
  channel.age += dt;
  channel.fresh = sample.has_value();
  channel.catches_up = false;
  if (sample) {
    const bool continued = channel.known && channel.age <= channel.hold && dt > 0;
    const double steps = continued ? channel.age / dt : 1;
    channel.mean = *sample;
    if (continued && trapezoid) channel.mean = channel.last + (*sample - channel.last) * (steps / 2);
    channel.catches_up = continued && trapezoid && channel.age > dt;
    if (channel.received && dt > channel.hold) channel.mean.reset();  // One sample is no mean of such a long step.
    // The gap also counts if the sample before was lost. Otherwise a device slower than the hold would stay lost.
    if (channel.received && channel.age > 0) {
      channel.gap = std::min(channel.age, std::exchange(channel.last_gap, channel.age));
      channel.hold = std::clamp(3 * channel.age, Tuning::kMinHoldTime, Tuning::kMaxHoldTime);
    }
    channel.last = *sample;
    channel.received = channel.known = true;
    channel.age = 0;
  } else if (channel.known && channel.age <= channel.hold) {
    channel.mean = channel.last;
  } else {
    channel.mean.reset();
    channel.known = false;
  }
}

void ImuSamples::step(const SensorFrame& sensors, const Eigen::Matrix3d& base_from_imu, double dt) noexcept {
  refused_ = false;
  const auto sample = [&](std::uint64_t bit, const Vector3& values, double range) -> std::optional<Eigen::Vector3d> {
    if ((sensors.valid & bit) == 0) return std::nullopt;
    const Eigen::Vector3d vector(values[0], values[1], values[2]);
    if (!(vector.squaredNorm() <= range * range)) {
      refused_ = true;
      return std::nullopt;
    }
    return Eigen::Vector3d(base_from_imu * vector);
  };
  const Eigen::Vector3d before = gyro_.last;
  accept(gyro_, sample(kValidGyro, sensors.imu.angular_velocity, Tuning::kGyroRange), dt, true);
  gyro_unchanged_ = gyro_.last == before ? gyro_unchanged_ + dt : 0;
  accept(accelerometer_, sample(kValidAccelerometer, sensors.imu.linear_acceleration, Tuning::kAccelerometerRange), dt,
         false);
}

}  // namespace robot_control
