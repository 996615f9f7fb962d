#include "control/wheeled/kinematics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control {

namespace {

double& of_side(SidePair& pair, Side side) noexcept {
  return side == Side::kLeft ? pair.left : pair.right;
}

double rim_limit(const DriveTrain& robot, const WheelModel& wheel) {
  const double limit = robot.joints[wheel.joint].velocity_limit;
  return limit > 0 ? kUsableWheelSpeed * limit * wheel.radius : std::numeric_limits<double>::infinity();
}

}  // namespace

DriveKinematics::DriveKinematics(const DriveTrain& robot)
    : wheels_(robot.wheels.size()),
      half_base_(0.5 * robot.effective_wheel_base()),
      rim_limit_{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()} {
  for (std::size_t i = 0; i < wheels_; ++i) {
    const WheelModel& wheel = robot.wheels[i];
    side_[i] = wheel.side;
    joint_per_rim_[i] = wheel.sign / wheel.radius;
    of_side(count_, wheel.side) += 1;
    double& limit = of_side(rim_limit_, wheel.side);
    limit = std::min(limit, rim_limit(robot, wheel));
  }
}

WheelValues DriveKinematics::joint_speeds(const PlanarTwist& twist) const noexcept {
  const SidePair rim = rim_speeds(twist);
  WheelValues speeds{};
  for (std::size_t i = 0; i < wheels_; ++i) {
    speeds[i] = (side_[i] == Side::kLeft ? rim.left : rim.right) * joint_per_rim_[i];
  }
  return speeds;
}

PlanarTwist DriveKinematics::twist(const WheelValues& joint_speeds) const noexcept {
  SidePair sum;
  for (std::size_t i = 0; i < wheels_; ++i) of_side(sum, side_[i]) += joint_speeds[i] / joint_per_rim_[i];
  const double left = sum.left / count_.left;
  const double right = sum.right / count_.right;
  return {0.5 * (left + right), 0.5 * (right - left) / half_base_};
}

double DriveKinematics::wheel_speed_scale(const PlanarTwist& twist) const noexcept {
  const SidePair rim = rim_speeds(twist);
  double scale = 1;
  if (std::abs(rim.left) > rim_limit_.left) scale = rim_limit_.left / std::abs(rim.left);
  if (std::abs(rim.right) > rim_limit_.right) scale = std::min(scale, rim_limit_.right / std::abs(rim.right));
  return scale;
}

double DriveKinematics::rim_speed_scale(const PlanarTwist& twist, double limit) const noexcept {
  const SidePair rim = rim_speeds(twist);
  const double fastest = std::max(std::abs(rim.left), std::abs(rim.right));
  const double allowed = limit > 0 ? limit : 0;
  return fastest <= allowed ? 1 : allowed / fastest;
}

}  // namespace robot_control
