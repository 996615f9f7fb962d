#include "safety/conditions/common/sensor_presence.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
SensorPresence::SensorPresence(const SafetyParameters& parameters, std::size_t joints, double period) noexcept
    : joints_(std::min(joints, kMaxJoints)),
      needed_(parameters.joint_numbers),
      period_(period),
      period_ns_(static_cast<std::uint64_t>(std::max(1LL, std::llround(period * 1e9)))),
      encoders_(kCauseEncodersLost, parameters.encoders_lost, period),
      imu_(kCauseImuLost, parameters.imu_lost, period) {}

void SensorPresence::enter_run() noexcept {
  joint_silent_ = {};
  imu_silent_ = imu_seen_ = 0;
}

void SensorPresence::report(ConditionWatch& watch, std::uint64_t cycles, std::uint64_t joint,
                            ActiveCauses& out) const noexcept {
  out.update(watch,
             at_once({.beyond = cycles >= watch.cycles(),
                      .value = static_cast<double>(cycles) * period_,
                      .limit = watch.persistence(),
                      .joint = joint}),
             1);
}

void SensorPresence::step_encoders(const SensorFrame& sensors, std::uint64_t elapsed, ActiveCauses& out) noexcept {
  std::size_t worst = 0;
  for (std::size_t i = 0; i < joints_; ++i) {
    const JointSample& sample = sensors.joints[i];
    const bool sampled = i < sensors.joint_count && has(sample, needed_);
    const auto age = static_cast<std::uint64_t>(std::max<std::int64_t>(0, sample.age_ns));
    joint_silent_[i] = sampled ? age / period_ns_ : joint_silent_[i] + elapsed;
    if (joint_silent_[i] > joint_silent_[worst]) worst = i;
  }
  report(encoders_, joint_silent_[worst], worst, out);
}

void SensorPresence::step(const SensorFrame& sensors, std::uint64_t elapsed, ActiveCauses& out) noexcept {
  step_encoders(sensors, elapsed, out);
  imu_seen_ |= sensors.valid & (kValidGyro | kValidAccelerometer);
  imu_silent_ = (imu_seen_ & ~sensors.valid) != 0 ? imu_silent_ + elapsed : 0;
  report(imu_, imu_silent_, kMaxJoints, out);
}

}  // namespace robot_control
