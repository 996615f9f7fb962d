#include "gate/wheeled/wheel_stop.h"

#include <algorithm>
#include <cmath>

#include "machine/gravity.h"
#include "machine/wheeled/tipping.h"

namespace robot_control {
namespace {

constexpr double kLiftingShare = 0.5;
constexpr double kMaxLiftingShare = 0.9;
constexpr double kMinPart = 0.1;
constexpr double kSlopeHeld = 10 * M_PI / 180;
constexpr double kSlopeBraked = 5 * M_PI / 180;
constexpr double kHoldSpeed = 0.03;  // m/s at the rim

}  // namespace

Brake wheel_brake(const DriveTrain& robot, std::size_t index, double motor_friction, double step) {
  const WheelModel& wheel = robot.wheels[index];
  const JointModel& joint = robot.joints[wheel.joint];
  double moved = robot.mass;
  for (const WheelModel& other : robot.wheels) moved += other.inertia / (other.radius * other.radius);
  const double lifting = lifting_deceleration(robot);
  const double half = moved * kLiftingShare * lifting;
  const double weight = robot.mass * kGravity;
  const double slope = weight * std::sin(kSlopeHeld);
  const double almost = std::min(slope, kMaxLiftingShare * moved * lifting);
  const double friction = joint.friction + motor_friction;
  const auto effort = [&](double force) {
    const double share = force * wheel.radius / static_cast<double>(robot.wheels.size());
    return std::min(std::max(share - friction, kMinPart * share), joint.effort_limit);
  };
  return {.effort = effort(std::max({half, weight * std::sin(kSlopeBraked), almost})),
          .hold_effort = effort(std::max(half, slope)),
          .damping = 0.4 * wheel.inertia / step,
          .stiffness = 0.06 * wheel.inertia / (step * step),
          .hold_speed = kHoldSpeed / wheel.radius};
}

std::vector<Brake> brakes_of_slow_drives(const DriveTrain& robot, double period) {
  constexpr double kPeriodFactor = 4.0 / 3;  // 0.4 J/h of wheel_brake becomes 0.3 J/period
  std::vector<Brake> brakes;
  for (std::size_t i = 0; i < robot.wheels.size(); ++i)
    brakes.push_back(wheel_brake(robot, i, 0, kPeriodFactor * period));
  return brakes;
}

StopAction wheel_stop(const DriveTrain& robot, std::size_t index, StopKind kind) {
  const double radius = robot.wheels[index].radius;
  const double share = robot.mass / static_cast<double>(robot.wheels.size());
  return {.kind = kind, .damping = share * radius * radius / kDampTime};
}

}  // namespace robot_control
