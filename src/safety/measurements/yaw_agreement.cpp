#include "safety/measurements/yaw_agreement.h"

#include <cmath>

namespace robot_control {
namespace {

/// Third row of the rotation matrix of q, which turns IMU axes into base axes.
Vector3 up_in_imu(const Quaternion& q) noexcept {
  const auto [x, y, z, w] = q;
  return {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)};
}

}  // namespace

YawAgreement::YawAgreement(const SafetyParameters& parameters, const DriveTrain& robot) noexcept
    : limit_(parameters.yaw_rate.limit.value_or(0)), up_imu_(up_in_imu(robot.imu_in_base.orientation)) {
  std::size_t i = 0;
  for (const WheelModel& wheel : robot.wheels) {
    const double beside = robot.wheels_beside(wheel);
    if (beside > 1) scrub_ = kScrub;
    const double share = wheel.sign * wheel.radius / (beside * robot.effective_wheel_base());
    yaw_per_speed_[i++] = wheel.side == Side::kRight ? share : -share;
  }
}

ConditionMeasurement YawAgreement::measure(const SensorFrame& sensors, const WheelMotion& motion) const noexcept {
  if (!motion.speed_known() || (sensors.valid & kValidGyro) == 0) return kNothingMeasured;
  double wheels = 0;
  double tolerance = 0;
  for (std::size_t i = 0; i < motion.wheels(); ++i) {
    wheels += yaw_per_speed_[i] * motion.speed(i);
    tolerance += std::abs(yaw_per_speed_[i]) * motion.speed_tolerance(i);
  }
  const Vector3& gyro = sensors.imu.angular_velocity;
  const double inertial = gyro[0] * up_imu_[0] + gyro[1] * up_imu_[1] + gyro[2] * up_imu_[2];
  return beyond(kMaxJoints, std::abs(inertial - wheels), limit_ + scrub_ * std::abs(wheels) + tolerance);
}

}  // namespace robot_control
