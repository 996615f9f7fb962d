#include "safety/conditions/sensor_presence.h"

namespace robot_control {

SensorPresence::Silence::Silence(StopCause cause, const Condition& condition, double period) noexcept
    : watch_(cause, condition, period), period_(period), persistence_(condition.persistence) {}

void SensorPresence::Silence::reset() noexcept {
  watch_.reset();
  cycles_ = 0;
}

void SensorPresence::Silence::step(bool silent, std::uint64_t elapsed, ActiveCauses& out) noexcept {
  cycles_ = silent ? cycles_ + elapsed : 0;
  out.update(watch_, {.beyond = silent, .value = static_cast<double>(cycles_) * period_, .limit = persistence_},
             elapsed);
}

SensorPresence::SensorPresence(const SafetyParameters& parameters, std::size_t wheels, double period) noexcept
    : wheels_(wheels),
      encoders_(kCauseEncodersLost, parameters.encoders_lost, period),
      imu_(kCauseImuLost, parameters.imu_lost, period) {}

void SensorPresence::enter_run() noexcept {
  encoders_.reset();
  imu_.reset();
  imu_seen_ = 0;
}

void SensorPresence::step(const SensorFrame& sensors, std::uint64_t elapsed, ActiveCauses& out) noexcept {
  encoders_.step((sensors.valid & kValidJoints) == 0 || sensors.joint_count < wheels_, elapsed, out);
  imu_seen_ |= sensors.valid & (kValidGyro | kValidAccelerometer);
  imu_.step((imu_seen_ & ~sensors.valid) != 0, elapsed, out);
}

}  // namespace robot_control
