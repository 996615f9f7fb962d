#include "drivers/mujoco/motors/brake_limits.h"

#include <algorithm>
#include <cmath>

#include "drivers/driver.h"
#include "machine/description/wording.h"
#include "machine/gravity.h"
#include "machine/wheeled/tipping.h"

namespace robot_control {
namespace {

constexpr double kPartOfLifting = 0.5;
constexpr double kAlmostLifting = 0.9;
constexpr double kMinPart = 0.1;
constexpr double kSlopeHeld = 10 * M_PI / 180;
constexpr double kSlopeBraked = 5 * M_PI / 180;
constexpr double kHoldSpeed = 0.03;  // m/s at the rim

}  // namespace

Brake brake_of(const DriveTrain& robot, std::size_t index, const MujocoPlantParameters& parameters, double step) {
  const WheelModel& wheel = robot.wheels[index];
  const JointModel& joint = robot.joints[wheel.joint];
  double moved = robot.mass;
  for (const WheelModel& other : robot.wheels) moved += other.inertia / (other.radius * other.radius);
  const double lifting = lifting_deceleration(robot);
  const double half = moved * kPartOfLifting * lifting;
  const double weight = robot.mass * kGravity;
  const double slope = weight * std::sin(kSlopeHeld);
  const double almost = std::min(slope, kAlmostLifting * moved * lifting);
  const double friction = joint.friction + parameters.gear_ratio * parameters.motor_friction;
  const auto effort = [&](double force) {
    const double share = force * wheel.radius / static_cast<double>(robot.wheels.size());
    return std::min(parameters.brake_effort.value_or(std::max(share - friction, kMinPart * share)), joint.effort_limit);
  };

  Brake brake;
  brake.effort = effort(std::max({half, weight * std::sin(kSlopeBraked), almost}));
  brake.hold_effort = effort(std::max(half, slope));
  brake.damping = parameters.brake_damping.value_or(0.4 * wheel.inertia / step);
  brake.stiffness = parameters.brake_stiffness.value_or(0.06 * wheel.inertia / (step * step));
  brake.hold_speed = parameters.brake_hold_speed.value_or(kHoldSpeed / wheel.radius);
  check_brake(brake, joint.name, wheel.inertia, step);
  return brake;
}

void check_brake(const Brake& brake, const std::string& joint, double inertia, double step) {
  const auto check = [&](const std::string& name, double value, double limit, const std::string& unit) {
    if (value > 0 && value <= limit) return;
    throw DriverError("mujoco_plant/" + name + " = " + number(value) + " " + unit + ": joint " + joint +
                      " has an inertia of only " + number(inertia) + " kg·m², a time step of " + number(step * 1000) +
                      " ms bears values above 0 up to " + number(limit) + " " + unit +
                      ". Set such a value, or leave it out.");
  };
  check("brake_damping", brake.damping, 0.5 * inertia / step, "N·m·s/rad");
  check("brake_stiffness", brake.stiffness, 0.5 * inertia / (step * step), "N·m/rad");
}

}  // namespace robot_control
