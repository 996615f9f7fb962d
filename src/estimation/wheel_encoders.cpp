#include "estimation/wheel_encoders.h"

#include <cmath>

namespace robot_control {

WheelEncoders::Wheel::Wheel(const WheelModel& wheel, const RobotModel& robot) noexcept
    : joint(wheel.joint), metres_per_radian(wheel.sign * wheel.radius), velocity_bound(1000) {
  const double limit = joint < robot.joints.size() ? robot.joints[joint].velocity_limit : 0;
  if (limit > 0 && std::isfinite(limit)) velocity_bound = 2 * limit;
}

bool WheelEncoders::Wheel::measured(const SensorFrame& sensors) const noexcept {
  return (sensors.valid & kValidJoints) != 0 && joint < sensors.joint_count && joint < kMaxJoints &&
         std::isfinite(sensors.joints[joint].position);
}

bool WheelEncoders::Wheel::plausible(const SensorFrame& sensors, double time) const noexcept {
  return std::abs(sensors.joints[joint].position - angle) <= velocity_bound * time + kSlack;
}

void WheelEncoders::Wheel::take(const SensorFrame& sensors) noexcept {
  const double position = sensors.joints[joint].position;
  travel = metres_per_radian * (position - angle);
  angle = position;
}

double WheelEncoders::Wheel::speed(const SensorFrame& sensors) const noexcept {
  if (!measured(sensors)) return 0;
  const double velocity = sensors.joints[joint].velocity;
  return std::abs(velocity) <= velocity_bound ? metres_per_radian * velocity : 0;  // 0 for NaN
}

WheelEncoders::WheelEncoders(const RobotModel& robot) noexcept : left_(robot.left, robot), right_(robot.right, robot) {}

void WheelEncoders::reset() noexcept {
  known_ = false;
  rejected_ = 0;
}

EncoderReading WheelEncoders::step(const SensorFrame& sensors, double time) noexcept {
  if (!left_.measured(sensors) || !right_.measured(sensors)) return EncoderReading::kRejected;
  EncoderReading reading = EncoderReading::kTravel;
  if (!known_) {
    reading = EncoderReading::kOffset;
  } else if (!left_.plausible(sensors, time) || !right_.plausible(sensors, time)) {
    if (++rejected_ <= kMaxRejected) return EncoderReading::kRejected;
    reading = EncoderReading::kLost;
  }
  left_.take(sensors);
  right_.take(sensors);
  if (reading != EncoderReading::kTravel) left_.travel = right_.travel = 0;
  known_ = true;
  rejected_ = 0;
  return reading;
}

}  // namespace robot_control
