#include "estimation/wheeled/wheels/side_encoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace robot_control {

SideEncoder::Wheel::Wheel(const WheelModel& wheel, const DriveTrain& robot, double bandwidth, double period)
    : joint(wheel.joint),
      metres_per_radian(wheel.sign * wheel.radius),
      velocity_bound(Tuning::kFastestWheel),
      tracking(bandwidth, period) {
  const double limit = joint < robot.joints.size() ? robot.joints[joint].velocity_limit : 0;
  if (limit > 0 && std::isfinite(limit)) velocity_bound = 2 * limit;
}

bool SideEncoder::Wheel::measured(const SensorFrame& sensors) const noexcept {
  return joint < sensors.joint_count && joint < kMaxJoints && has_position(sensors.joints[joint]) &&
         taken.precedes(sensors, sensors.joints[joint]);
}

bool SideEncoder::Wheel::plausible(const SensorFrame& sensors, const Wait& wait) const noexcept {
  const double position = sensors.joints[joint].position, velocity = tracking.velocity();
  const double off = std::abs(position - angle - velocity * wait.time);
  const double usual = Tuning::kNewZero + std::abs(velocity) * wait.late;
  const bool zero = std::abs(position) <= Tuning::kEncoderSlack + std::abs(velocity) * wait.time;
  if (off > usual + (zero ? 0 : Tuning::kFastestSpinUp / 2 * wait.open * wait.open)) return false;
  const double turned = position - angle - velocity * (wait.time - wait.open);
  return std::abs(turned) <= velocity_bound * wait.open + Tuning::kEncoderSlack;
}

bool SideEncoder::Wheel::lost_zero(const SensorFrame& sensors) noexcept {
  if (joint >= sensors.joint_count || joint >= kMaxJoints) return false;
  const bool faulty_before = std::exchange(faulty, sensors.joints[joint].fault != 0);
  return (faulty || faulty_before) && !has(sensors.joints[joint], kValidPosition);
}

double SideEncoder::Wheel::accept(const SensorFrame& sensors) noexcept {
  const double position = sensors.joints[joint].position;
  taken.accept(sensors, sensors.joints[joint]);
  return metres_per_radian * (position - std::exchange(angle, position));
}

void SideEncoder::Wheel::track(double periods) noexcept {
  if (periods > 0) return tracking.step(angle, 0, periods);
  tracking.restart_from(angle, tracking.velocity());
}

SideEncoder::SideEncoder(const DriveTrain& robot, Side side, double bandwidth, double period) : period_(period) {
  for (const WheelModel& wheel : robot.wheels) {
    if (wheel.side == side) wheels_.emplace_back(wheel, robot, bandwidth, period);
  }
}

double SideEncoder::speed() const noexcept {
  double sum = 0;
  for (const Wheel& wheel : wheels_) sum += wheel.metres_per_radian * wheel.tracking.velocity();
  return sum / static_cast<double>(wheels_.size());
}

void SideEncoder::set_speed(double speed) noexcept {
  for (Wheel& wheel : wheels_) wheel.tracking.restart_from(wheel.angle, speed / wheel.metres_per_radian);
}

void SideEncoder::assume_encoder_of(const SideEncoder& other) noexcept {
  for (Wheel& wheel : wheels_) wheel.tracking.assume_encoder_of(other.wheels_.begin()->tracking);
}

void SideEncoder::write(std::array<double, kMaxJoints>& joint_velocity) const noexcept {
  for (const Wheel& wheel : wheels_) joint_velocity[wheel.joint] = wheel.tracking.velocity();
}

EncoderReading SideEncoder::step(const SensorFrame& sensors, double dt) noexcept {
  travel_ = 0;
  waiting_ += dt;
  const auto measured = [&](const Wheel& wheel) { return wheel.measured(sensors); };
  if (rejected_ == 0) open_ = waiting_;
  const Wait wait{.time = waiting_, .open = open_, .late = rejected_ == 0 ? waiting_ + gap_ : 0};
  const auto plausible = [&](const Wheel& wheel) { return wheel.plausible(sensors, wait); };
  for (Wheel& wheel : wheels_) zero_lost_ = wheel.lost_zero(sensors) || zero_lost_;
  if (!std::ranges::all_of(wheels_, measured)) return EncoderReading::kRejected;
  EncoderReading reading = EncoderReading::kTravel;
  if (!known_) {
    reading = EncoderReading::kOffset;
  } else if (zero_lost_) {
    reading = EncoderReading::kLost;
  } else if (!std::ranges::all_of(wheels_, plausible)) {
    if (++rejected_ <= Tuning::kMaxHeld) return EncoderReading::kRejected;
    reading = EncoderReading::kLost;
  }
  double sum = 0;
  since_lost_ = reading == EncoderReading::kLost ? 0 : since_lost_ + waiting_;
  const bool continues = reading == EncoderReading::kTravel && since_lost_ >= Tuning::kMaxHoldTime;
  for (Wheel& wheel : wheels_) {
    sum += wheel.accept(sensors);
    wheel.track(continues ? waiting_ / period_ : 0);
  }
  if (reading == EncoderReading::kTravel) travel_ = sum / static_cast<double>(wheels_.size());
  time_ = waiting_;
  gap_ = std::min(std::max(waiting_, (1 - Tuning::kForgetting) * gap_), Tuning::kMaxGap);
  waiting_ = 0;
  known_ = true;
  zero_lost_ = false;
  rejected_ = 0;
  return reading;
}

}  // namespace robot_control
