#include "control/wheeled/wheel_loops/feed_forward.h"

#include <cmath>

namespace robot_control {

namespace {

constexpr double kFrictionSpeed = 0.1;  // rad/s, ε of the header

}  // namespace

FeedForward::FeedForward(const DriveTrain& robot)
    : mass_(robot.mass),
      yaw_inertia_(robot.yaw_inertia),
      centre_ahead_(robot.centre_of_gravity_base[0] - middle_of_axles(robot)[0]),
      wheel_base_(robot.wheel_base),
      half_base_(0.5 * robot.effective_wheel_base()),
      wheels_(robot.wheels.size()) {
  for (std::size_t i = 0; i < wheels_; ++i) {
    const WheelModel& wheel = robot.wheels[i];
    side_[i] = wheel.side == Side::kLeft ? -1 : 1;
    effort_per_force_[i] = wheel.sign * wheel.radius / robot.wheels_beside(wheel);
    turn_per_rim_[i] = wheel.sign / wheel.radius;
    effort_per_acceleration_[i] = turn_per_rim_[i] * wheel.inertia;
    damping_[i] = robot.joints[wheel.joint].damping;
    friction_[i] = robot.joints[wheel.joint].friction;
  }
}

void FeedForward::tune(const DriveTuning& tuning) noexcept {
  mass_ = tuning.mass;
  yaw_inertia_ = tuning.yaw_inertia;
  for (std::size_t i = 0; i < wheels_; ++i) {
    const WheelTuning& wheel = tuning.wheels[i];
    effort_per_acceleration_[i] = turn_per_rim_[i] * wheel.inertia;
    damping_[i] = wheel.damping;
    friction_[i] = wheel.friction;
  }
}

WheelValues FeedForward::efforts(const PlanarTwist& twist, const PlanarTwist& acceleration) const noexcept {
  const double force = mass_ * (acceleration.linear - centre_ahead_ * twist.angular * twist.angular);
  const double moment = yaw_inertia_ * acceleration.angular + mass_ * centre_ahead_ * twist.linear * twist.angular;
  const double difference = moment / wheel_base_;
  const double rim_difference = half_base_ * acceleration.angular;
  const double rim_speed_difference = half_base_ * twist.angular;
  WheelValues efforts{};
  for (std::size_t i = 0; i < wheels_; ++i) {
    efforts[i] = effort_per_force_[i] * (0.5 * force + side_[i] * difference) +
                 effort_per_acceleration_[i] * (acceleration.linear + side_[i] * rim_difference);
    const double velocity = turn_per_rim_[i] * (twist.linear + side_[i] * rim_speed_difference);
    efforts[i] += damping_[i] * velocity;
    if (friction_[i] != 0)
      efforts[i] += friction_[i] * std::tanh(velocity / kFrictionSpeed);  // A call of tanh takes 10 ns.
  }
  return efforts;
}

}  // namespace robot_control
