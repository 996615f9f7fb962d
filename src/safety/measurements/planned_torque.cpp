#include "safety/measurements/planned_torque.h"

#include <algorithm>

namespace robot_control {

PlannedTorque::PlannedTorque(const DriveTrain& robot) noexcept
    : count_(std::min(robot.wheels.size(), kMaxWheels)),
      mass_(robot.mass),
      yaw_inertia_(robot.yaw_inertia),
      base_(robot.wheel_base),
      effective_base_(robot.effective_wheel_base()) {
  for (std::size_t i = 0; i < count_; ++i) {
    const WheelModel& wheel = robot.wheels[i];
    wheels_[i] = {.side = wheel.side == Side::kLeft ? -1.0 : 1.0,
                  .rim = wheel.sign * wheel.radius,
                  .beside = robot.wheels_beside(wheel),
                  .inertia = wheel.inertia};
  }
}

void PlannedTorque::enter_run() noexcept {
  had_all_ = false;
  torque_ = {};
}

void PlannedTorque::step(const WheelTargets& targets, double dt) noexcept {
  const bool had_all = had_all_;
  had_all_ = true;
  double linear = 0, difference = 0;  // m/s², of the rims
  std::array<double, kMaxWheels> rate{};
  for (std::size_t i = 0; i < count_; ++i) {
    had_all_ = had_all_ && targets.has(i);
    rate[i] = (targets[i] - last_[i]) / dt;
    last_[i] = targets[i];
    const double acceleration = wheels_[i].rim * rate[i] / wheels_[i].beside;
    linear += 0.5 * acceleration;
    difference += wheels_[i].side * acceleration;
  }
  torque_ = {};
  if (!had_all || !had_all_) return;
  const double force = 0.5 * mass_ * linear;
  const double pair = yaw_inertia_ * difference / (effective_base_ * base_);
  for (std::size_t i = 0; i < count_; ++i) {
    const Wheel& wheel = wheels_[i];
    torque_[i] = wheel.rim / wheel.beside * (force + wheel.side * pair) + wheel.inertia * rate[i];
  }
}

}  // namespace robot_control
