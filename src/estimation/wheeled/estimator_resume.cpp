// The estimator continues an earlier process from its last published frame.

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "estimation/common/values.h"
#include "estimation/wheeled/estimator.h"
#include "signals/rotation.h"

namespace robot_control {
namespace {

bool continuable(const BaseState& last, const WheelCalibration& c) noexcept {
  bool good = (last.flags & kStateValid) != 0 && finite(last.pose_odom.position) && finite(last.twist_base.linear) &&
              finite(last.twist_base.angular) && finite(last.gyro_bias) && finite(last.accelerometer_bias) &&
              finite(last.gyro_bias_deviation) && std::isfinite(last.distance) &&
              std::isfinite(yaw_of(last.pose_odom.orientation));
  for (const double entry : last.pose_covariance) good = good && std::isfinite(entry);
  for (const double entry : {c.radius_ratio, c.wheel_base_factor, c.radius_ratio_deviation, c.wheel_base_deviation}) {
    good = good && std::isfinite(entry);
  }
  const Quaternion& q = last.attitude;
  return good && std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-6;
}

/// Returns the covariance of a frame's pose, moved from base_link to the middle of the wheels by `lever`, m.
Eigen::Matrix3d covariance_of_middle(const StateFrame& frame, const Planar& lever) noexcept {
  using Full = Eigen::Matrix<double, 6, 6>;
  const std::array<int, 3> plane{0, 1, 5};  // x, y and yaw
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
  jacobian.col(2) << -lever.y, lever.x, 1;
  return jacobian * Eigen::Map<const Full>(frame.base.pose_covariance.data())(plane, plane) * jacobian.transpose();
}

}  // namespace

void Estimator::resume(const StateFrame& last) noexcept {
  enter_run();
  if (!continuable(last.base, last.wheeled.calibration)) return;
  State& s = state_;
  const Eigen::Vector3d bias = base_from_imu_ * vector(last.base.gyro_bias);
  const Eigen::Vector3d force = base_from_imu_ * vector(last.base.accelerometer_bias);
  const Eigen::Vector3d variance = base_from_imu_.cwiseAbs2() * vector(last.base.gyro_bias_deviation).cwiseAbs2();
  for (const int i : {0, 1}) s.gyro_bias[i] = {bias[i], variance[i]};
  s.core.set_bias(bias.z(), std::sqrt(variance.z()));
  s.core.set_calibration(last.wheeled.calibration);
  s.tilt.set(array(rotation_of(last.base.attitude).row(2)), {force.x(), force.y()});
  s.height = last.base.pose_odom.position[2];
  place({last.base.pose_odom.position[0], last.base.pose_odom.position[1], yaw_of(last.base.pose_odom.orientation)});
  s.core.set_pose_covariance(covariance_of_middle(last, axle(yaw_of(last.base.pose_odom.orientation))));
  s.yaw_rate = last.base.twist_base.angular[2];
  const double speed = last.base.twist_base.linear[0] - s.yaw_rate * geometry_.axle[1];
  const double faster = s.yaw_rate * geometry_.wheel_base / 2;
  s.wheel_sides.set_speed(speed - faster, speed + faster);
  s.rest.resume();
  s.wheel_odometry = last.wheeled.odometry;
  s.distance = last.base.distance;
  s.rejected = last.wheeled.rejected;
  s.skipped = last.skipped;
  s.cycle = last.head.cycle;
  s.began = s.restarted = s.restart_pending = true;
}

}  // namespace robot_control
