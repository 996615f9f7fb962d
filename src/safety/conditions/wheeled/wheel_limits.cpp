#include "safety/conditions/wheeled/wheel_limits.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

SpeedLimitInForce::SpeedLimitInForce(double ramp_time, double period) noexcept
    : cycles_(static_cast<std::uint64_t>(std::llround(ramp_time / period))) {}

void SpeedLimitInForce::enter_run() noexcept {
  since_ = 0;
  last_ = now_ = kNoSpeedLimit;
}

double SpeedLimitInForce::step(double speed_limit, std::uint64_t elapsed) noexcept {
  now_ = std::max(now_, speed_limit);
  since_ += elapsed;
  if (since_ >= cycles_) {
    since_ = 0;
    last_ = now_;
    now_ = speed_limit;
  }
  return std::max(last_, now_);
}

WheelLimits::WheelLimits(const SafetyParameters& parameters, const DriveTrain& robot, double period) noexcept
    : speed_(kCauseWheelSpeed, parameters.wheel_speed, period),
      acceleration_(kCauseWheelAcceleration, parameters.wheel_acceleration, period),
      effort_(kCauseWheelEffort, parameters.wheel_effort, period),
      power_(kCausePower, parameters.power, period),
      in_force_(parameters.ramp_time, period) {
  for (std::size_t i = 0; i < std::min(robot.wheels.size(), kMaxWheels); ++i) {
    radius_[i] = robot.wheels[i].radius;
    effort_limit_[i] = robot.joints[i].effort_limit;
  }
}

void WheelLimits::enter_run() noexcept {
  speed_.reset();
  acceleration_.reset();
  effort_.reset();
  power_.reset();
  in_force_.enter_run();
}

void WheelLimits::step(const SensorFrame& sensors, const WheelMotion& motion, bool passed, double speed_limit,
                       std::uint64_t elapsed, ActiveCauses& out) noexcept {
  const double in_force = in_force_.step(speed_limit, elapsed);
  const bool known = motion.speed_known();
  const ConditionMeasurement speed = known ? fastest(motion, in_force) : kNothingMeasured;
  out.update(speed_, speed, weighed(speed, elapsed));
  out.update(acceleration_, motion.acceleration_known() ? most_jerked(motion) : kNothingMeasured, elapsed);
  const bool measured = joints_have(sensors, motion.wheels(), kValidEffort);
  out.update(effort_, motion.sampled() && passed && measured ? strongest(sensors) : kNothingMeasured, elapsed);
  out.update(power_, known && measured ? drawn(sensors, motion) : kNothingMeasured, elapsed);
}

ConditionMeasurement WheelLimits::fastest(const WheelMotion& motion, double speed_limit) const noexcept {
  ConditionMeasurement measurement = kNothingMeasured;
  for (std::size_t i = 0; i < motion.wheels(); ++i) {
    const double slowed = (kSlack * speed_limit + kSlackSpeed) / radius_[i];
    const double limit = std::min(speed_.limit(), slowed) + motion.speed_tolerance(i);
    measurement = worse(measurement, beyond(i, std::abs(motion.speed(i)), limit));
  }
  return measurement;
}

ConditionMeasurement WheelLimits::most_jerked(const WheelMotion& motion) const noexcept {
  ConditionMeasurement measurement = kNothingMeasured;
  for (std::size_t i = 0; i < motion.wheels(); ++i) {
    const double limit = acceleration_.limit() + motion.acceleration_tolerance(i);
    measurement = worse(measurement, beyond(i, std::abs(motion.acceleration(i)), limit));
  }
  return measurement;
}

ConditionMeasurement WheelLimits::strongest(const SensorFrame& sensors) const noexcept {
  ConditionMeasurement measurement = kNothingMeasured;
  for (std::size_t i = 0; i < effort_limit_.size() && effort_limit_[i] > 0; ++i) {
    measurement = worse(measurement, beyond(i, std::abs(sensors.joints[i].effort) / effort_limit_[i], effort_.limit()));
  }
  return measurement;
}

ConditionMeasurement WheelLimits::drawn(const SensorFrame& sensors, const WheelMotion& motion) const noexcept {
  double power = 0;
  double limit = power_.limit();
  for (std::size_t i = 0; i < motion.wheels(); ++i) {
    const double effort = sensors.joints[i].effort;
    power += std::max(0.0, effort * motion.speed(i));
    limit += std::abs(effort) * motion.speed_tolerance(i);
  }
  return beyond(kMaxJoints, power, limit);
}

}  // namespace robot_control
