#include "estimation/wheel_encoders.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

WheelEncoders::Wheel::Wheel(const WheelModel& wheel, const RobotModel& robot) noexcept
    : joint(wheel.joint), side(wheel.side), metres_per_radian(wheel.sign * wheel.radius), velocity_bound(1000) {
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

double WheelEncoders::Wheel::take(const SensorFrame& sensors) noexcept {
  const double position = sensors.joints[joint].position;
  const double travel = metres_per_radian * (position - angle);
  angle = position;
  return travel;
}

double WheelEncoders::Wheel::speed(const SensorFrame& sensors) const noexcept {
  if (!measured(sensors)) return 0;
  const double velocity = sensors.joints[joint].velocity;
  return std::abs(velocity) <= velocity_bound ? metres_per_radian * velocity : 0;  // 0 for NaN
}

WheelEncoders::WheelEncoders(const RobotModel& robot)
    : share_left_(1.0 / static_cast<double>(std::ranges::count(robot.wheels, Side::kLeft, &WheelModel::side))),
      share_right_(1.0 / static_cast<double>(std::ranges::count(robot.wheels, Side::kRight, &WheelModel::side))) {
  for (const WheelModel& wheel : robot.wheels) wheels_.emplace_back(wheel, robot);
}

void WheelEncoders::reset() noexcept {
  known_ = false;
  rejected_ = 0;
}

EncoderReading WheelEncoders::step(const SensorFrame& sensors, double time) noexcept {
  const auto measured = [&](const Wheel& wheel) { return wheel.measured(sensors); };
  const auto plausible = [&](const Wheel& wheel) { return wheel.plausible(sensors, time); };
  if (!std::ranges::all_of(wheels_, measured)) return EncoderReading::kRejected;
  EncoderReading reading = EncoderReading::kTravel;
  if (!known_) {
    reading = EncoderReading::kOffset;
  } else if (!std::ranges::all_of(wheels_, plausible)) {
    if (++rejected_ <= kMaxRejected) return EncoderReading::kRejected;
    reading = EncoderReading::kLost;
  }
  left_ = right_ = 0;
  for (Wheel& wheel : wheels_) {
    const double travel = wheel.take(sensors);
    if (reading != EncoderReading::kTravel) continue;
    (wheel.side == Side::kLeft ? left_ : right_) += travel;
  }
  left_ *= share_left_;
  right_ *= share_right_;
  known_ = true;
  rejected_ = 0;
  return reading;
}

double WheelEncoders::speed(const SensorFrame& sensors, Side side) const noexcept {
  double sum = 0;
  for (const Wheel& wheel : wheels_) sum += wheel.side == side ? wheel.speed(sensors) : 0;
  return sum * (side == Side::kLeft ? share_left_ : share_right_);
}

double WheelEncoders::left_speed(const SensorFrame& sensors) const noexcept {
  return speed(sensors, Side::kLeft);
}

double WheelEncoders::right_speed(const SensorFrame& sensors) const noexcept {
  return speed(sensors, Side::kRight);
}

}  // namespace robot_control
