#include "estimation/filter/placing.h"

#include <cmath>

#include "estimation/filter/algebra.h"

namespace robot_control {
namespace {

using namespace algebra;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Filter = ErrorStateFilter;

}  // namespace

void place(const Vector3& pose, ErrorStateFilter& filter) noexcept {
  const Matrix3d turn = about_z(pose[2] - yaw_of(filter.rotation));
  const double z = filter.position.z();
  filter.rotation = turn * filter.rotation;
  const Vector3d lever = filter.rotation * filter.geometry().imu_in_base;
  filter.position = {pose[0] + lever.x(), pose[1] + lever.y(), z};
  auto& p = filter.covariance;
  p.middleCols<3>(Filter::kOrientation) = (p.middleCols<3>(Filter::kOrientation) * turn.transpose()).eval();
  p.middleRows<3>(Filter::kOrientation) = (turn * p.middleRows<3>(Filter::kOrientation)).eval();
  // base_link and yaw are exact; what the tilt is in doubt by then moves θ_z and, on its lever, the IMU.
  const double a = -yaw_by_tilt(filter.rotation).x();
  const double b = -yaw_by_tilt(filter.rotation).y();
  constexpr int kPlaced[] = {Filter::kPosition, Filter::kPosition + 1, Filter::kPosition + 2, Filter::kOrientation + 2};
  const double by_tilt[][2] = {{-a * lever.y(), lever.z() - b * lever.y()},
                               {a * lever.x() - lever.z(), b * lever.x()},
                               {lever.y(), -lever.x()},
                               {a, b}};
  constexpr int x = Filter::kOrientation;
  for (int i = 0; i < 4; ++i) p.col(kPlaced[i]) = by_tilt[i][0] * p.col(x) + by_tilt[i][1] * p.col(x + 1);
  for (int i = 0; i < 4; ++i) p.row(kPlaced[i]) = by_tilt[i][0] * p.row(x) + by_tilt[i][1] * p.row(x + 1);
}

bool continuable(const StateFrame& last) noexcept {
  bool good = (last.flags & kStateValid) != 0 && finite(last.pose_odom.position) && finite(last.twist_base.linear) &&
              finite(last.twist_base.angular) && finite(last.gyro_bias) && finite(last.accelerometer_bias) &&
              finite(last.gyro_bias_deviation) && std::isfinite(last.distance) &&
              std::isfinite(yaw_of(last.pose_odom.orientation));
  for (const double entry : last.pose_covariance) good = good && std::isfinite(entry);
  const WheelCalibration& c = last.calibration;
  for (const double entry : {c.radius_ratio, c.wheel_base_factor, c.radius_ratio_deviation, c.wheel_base_deviation}) {
    good = good && std::isfinite(entry);
  }
  const Quaternion& q = last.attitude;
  return good && std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-6;
}

void continue_from(const StateFrame& last, const Matrix3d& base_from_imu, ErrorStateFilter& filter) noexcept {
  filter.rotation = rotation_of(last.attitude);
  place({last.pose_odom.position[0], last.pose_odom.position[1], yaw_of(last.pose_odom.orientation)}, filter);
  filter.position.z() = last.pose_odom.position[2] + (filter.rotation * filter.geometry().imu_in_base).z();
  filter.gyro_bias = base_from_imu * vector(last.gyro_bias);
  filter.accelerometer_bias = base_from_imu * vector(last.accelerometer_bias);
  filter.radius_ratio = last.calibration.radius_ratio - 1;
  filter.wheel_base = last.calibration.wheel_base_factor - 1;
  filter.velocity =
      vector(last.twist_base.linear) + vector(last.twist_base.angular).cross(filter.geometry().imu_in_base);
  auto& p = filter.covariance;
  for (int i = 0; i < 3; ++i) p(Filter::kVelocity + i, Filter::kVelocity + i) = square(kUnknownSpeed);
  p(Filter::kRadiusRatio, Filter::kRadiusRatio) = square(last.calibration.radius_ratio_deviation);
  p(Filter::kWheelBase, Filter::kWheelBase) = square(last.calibration.wheel_base_deviation);
  for (int i = 0; i < 3; ++i) {
    p(Filter::kGyroBias + i, Filter::kGyroBias + i) = square(last.gyro_bias_deviation[static_cast<std::size_t>(i)]);
  }
  constexpr int kIndex[3] = {Filter::kPosition, Filter::kPosition + 1, Filter::kOrientation + 2};
  constexpr std::size_t kEntry[3] = {0, 1, 5};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) p(kIndex[i], kIndex[j]) += last.pose_covariance[6 * kEntry[i] + kEntry[j]];
  }
}

}  // namespace robot_control
