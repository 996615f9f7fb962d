#pragma once
/// The speed of the robot along its x axis, as the mean rim speed of its drive wheels. It belongs to the point in the
/// middle of the axles. It is the drives' own velocity, so it needs no samples of earlier cycles.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "machine/wheeled/drive_train.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class RimSpeed {
 public:
  explicit RimSpeed(const DriveTrain& robot) noexcept : count_(std::min(robot.wheels.size(), kMaxWheels)) {
    for (std::size_t i = 0; i < count_; ++i) rim_per_joint_[i] = robot.wheels[i].sign * robot.wheels[i].radius;
  }

  /// Returns the speed in m/s; 0 while the joint samples are not valid or not finite.
  double value(const SensorFrame& sensors) const noexcept {
    if (count_ == 0 || !joints_have(sensors, count_, kValidVelocity)) return 0;
    double sum = 0;
    for (std::size_t i = 0; i < count_; ++i) sum += rim_per_joint_[i] * sensors.joints[i].velocity;
    return std::isfinite(sum) ? sum / static_cast<double>(count_) : 0;
  }

 private:
  std::size_t count_;
  std::array<double, kMaxWheels> rim_per_joint_{};  ///< m/s per rad/s, forwards
};

}  // namespace robot_control
