#include "safety/derived_limits.h"

#include <algorithm>

namespace robot_control {
namespace {

void fill(Condition& condition, double limit) {
  if (!condition.limit) condition.limit = limit;
}

constexpr double kSpeedFactor = 1.1;

double wheel_speed_limit(const DriveTrain& robot, double commanded) {
  double bearable = 1.25 * commanded;
  for (const WheelModel& wheel : robot.wheels) {
    const double limit = robot.joints[wheel.joint].velocity_limit;
    if (limit <= 0) continue;
    commanded = std::min(commanded, limit);
    bearable = std::min(bearable, limit);
  }
  return std::max(least_wheel_speed_limit(commanded), std::min(1.25 * commanded, bearable));
}

}  // namespace

double least_wheel_speed_limit(double commanded) noexcept {
  return std::max(kSpeedFactor * commanded, commanded + kSpeedMargin);
}

double fastest_within(double wheel_speed_limit) noexcept {
  return std::min(wheel_speed_limit / kSpeedFactor, wheel_speed_limit - kSpeedMargin);
}

SafetyParameters derived_limits(const SafetyParameters& given, const DriveTrain& robot, double commanded_wheel_speed,
                                double period) {
  SafetyParameters limits = given;
  fill(limits.wheel_speed, wheel_speed_limit(robot, commanded_wheel_speed));
  const double speed = *limits.wheel_speed.limit;
  double acceleration = 0, power = 0;
  for (const WheelModel& wheel : robot.wheels) {
    const double effort = robot.joints[wheel.joint].effort_limit;
    acceleration = std::max(acceleration, 2 * effort / wheel.inertia + speed / std::max(kSpeedWindow, 2 * period));
    power += effort * speed;
  }
  fill(limits.wheel_acceleration, acceleration);
  fill(limits.power, power);
  fill(limits.stall, (robot.wheels.size() > 2 ? kScrubbingStall : kStall) * std::max(1.0, period / 0.001));
  fill(limits.not_stopping, kNotStopping * std::max(1.0, period / kSlowLoop));
  fill(limits.runaway, std::max(0.2 * speed, kMinRunaway) * std::max(1.0, period / kSlowLoop));
  return limits;
}

}  // namespace robot_control
