#include "control/feed_forward.h"

namespace robot_control {

double straight_inertia(const RobotModel& robot, const WheelModel& wheel) noexcept {
  return wheel.inertia + 0.5 * robot.mass * wheel.radius * wheel.radius;
}

double turning_inertia(const RobotModel& robot, const WheelModel& wheel) noexcept {
  const double lever = wheel.radius / robot.wheel_base;
  return wheel.inertia + 2 * robot.yaw_inertia * lever * lever;
}

FeedForward::FeedForward(const RobotModel& robot)
    : mass_(robot.mass),
      yaw_inertia_(robot.yaw_inertia),
      centre_ahead_(robot.centre_of_gravity_base[0] - 0.5 * (robot.left.centre_base[0] + robot.right.centre_base[0])),
      wheel_base_(robot.wheel_base),
      effort_per_force_{robot.left.sign * robot.left.radius, robot.right.sign * robot.right.radius},
      effort_per_acceleration_{robot.left.sign * robot.left.inertia / robot.left.radius,
                               robot.right.sign * robot.right.inertia / robot.right.radius} {}

WheelPair FeedForward::efforts(const PlanarTwist& twist, const PlanarTwist& acceleration) const noexcept {
  const double force = mass_ * (acceleration.linear - centre_ahead_ * twist.angular * twist.angular);
  const double moment = yaw_inertia_ * acceleration.angular + mass_ * centre_ahead_ * twist.linear * twist.angular;
  const double difference = moment / wheel_base_;
  const double rim_difference = 0.5 * wheel_base_ * acceleration.angular;
  return {effort_per_force_.left * (0.5 * force - difference) +
              effort_per_acceleration_.left * (acceleration.linear - rim_difference),
          effort_per_force_.right * (0.5 * force + difference) +
              effort_per_acceleration_.right * (acceleration.linear + rim_difference)};
}

}  // namespace robot_control
