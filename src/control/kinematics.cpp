#include "control/kinematics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control {

namespace {

double rim_limit(const RobotModel& robot, const WheelModel& wheel) {
  const double limit = robot.joints[wheel.joint].velocity_limit;
  return limit > 0 ? limit * wheel.radius : std::numeric_limits<double>::infinity();
}

}  // namespace

DriveKinematics::DriveKinematics(const RobotModel& robot)
    : half_base_(0.5 * robot.wheel_base),
      joint_per_rim_{robot.left.sign / robot.left.radius, robot.right.sign / robot.right.radius},
      rim_limit_{rim_limit(robot, robot.left), rim_limit(robot, robot.right)} {}

WheelPair DriveKinematics::rim_speeds(const PlanarTwist& twist) const noexcept {
  return {twist.linear - half_base_ * twist.angular, twist.linear + half_base_ * twist.angular};
}

WheelPair DriveKinematics::joint_speeds(const PlanarTwist& twist) const noexcept {
  const WheelPair rim = rim_speeds(twist);
  return {rim.left * joint_per_rim_.left, rim.right * joint_per_rim_.right};
}

PlanarTwist DriveKinematics::twist(const WheelPair& joint_speeds) const noexcept {
  const double left = joint_speeds.left / joint_per_rim_.left;
  const double right = joint_speeds.right / joint_per_rim_.right;
  return {0.5 * (left + right), 0.5 * (right - left) / half_base_};
}

double DriveKinematics::wheel_speed_scale(const PlanarTwist& twist) const noexcept {
  const WheelPair rim = rim_speeds(twist);
  double scale = 1;
  if (std::abs(rim.left) > rim_limit_.left) scale = rim_limit_.left / std::abs(rim.left);
  if (std::abs(rim.right) > rim_limit_.right) scale = std::min(scale, rim_limit_.right / std::abs(rim.right));
  return scale;
}

}  // namespace robot_control
