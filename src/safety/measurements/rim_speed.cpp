#include "safety/measurements/rim_speed.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

RimSpeed::RimSpeed(const DriveTrain& robot) noexcept : count_(std::min(robot.wheels.size(), kMaxWheels)) {
  for (std::size_t i = 0; i < count_; ++i) {
    const WheelModel& wheel = robot.wheels[i];
    wheels_[i] = {.joint = wheel.joint, .rim_per_joint = wheel.sign * wheel.radius};
  }
}

double RimSpeed::value(const SensorFrame& sensors) const noexcept {
  if (count_ == 0) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const JointSample& sample = sensors.joints[wheels_[i].joint];
    if (!has(sample, kValidVelocity)) return 0;
    sum += wheels_[i].rim_per_joint * sample.velocity;
  }
  return std::isfinite(sum) ? sum / static_cast<double>(count_) : 0;
}

}  // namespace robot_control
