#include "estimation/filter/state_output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "estimation/filter/algebra.h"

namespace robot_control {
namespace {

using namespace algebra;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Filter = ErrorStateFilter;
using Covariance6 = Eigen::Matrix<double, 6, 6>;

void write(const Covariance6& covariance, bool planar, Matrix6& out) noexcept {
  constexpr std::array<int, 6> kAll{0, 1, 2, 3, 4, 5};
  constexpr std::array<int, 3> kPlane{0, 1, 5};
  out = {};
  if (planar) {
    for (const std::size_t i : {2U, 3U, 4U}) out[7 * i] = kPlanarVariance;
  }
  const std::span<const int> axes = planar ? std::span<const int>(kPlane) : std::span<const int>(kAll);
  for (const int i : axes) {
    for (const int j : axes) out[static_cast<std::size_t>(6 * i + j)] = covariance(i, j);
  }
}

}  // namespace

void write_pose(const ErrorStateFilter& filter, bool planar, StateFrame& out) noexcept {
  const Matrix3d& r = filter.rotation;
  const Vector3d lever = r * filter.geometry().imu_in_base;
  const Vector3d base = filter.position - lever;
  const auto& p = filter.covariance;
  Covariance6 by = Covariance6::Identity();
  by.topRightCorner<3, 3>() = cross_matrix(lever);
  if (planar) by.row(5).segment<2>(3) = yaw_by_tilt(r).transpose();
  const Covariance6 joint = p.topLeftCorner<6, 6>();
  write(by * joint * by.transpose(), planar, out.pose_covariance);

  out.attitude = quaternion_of(r);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      out.attitude_covariance[static_cast<std::size_t>(3 * i + j)] =
          p(Filter::kOrientation + i, Filter::kOrientation + j);
    }
  }
  const double yaw = yaw_of(r);
  out.pose_odom = planar ? Pose{{base.x(), base.y(), 0}, {0, 0, std::sin(yaw / 2), std::cos(yaw / 2)}}
                         : Pose{array(base), out.attitude};
}

void write_twist(const ErrorStateFilter& filter, const Vector3d& rate, const RateNoise& noise, bool planar,
                 StateFrame& out) noexcept {
  const auto& p = filter.covariance;
  const Vector3d& imu = filter.geometry().imu_in_base;
  const Vector3d linear = filter.velocity - filter.rate.cross(imu);
  Covariance6 joint = Covariance6::Zero();
  joint.topLeftCorner<3, 3>() = p.block<3, 3>(Filter::kVelocity, Filter::kVelocity);
  if (noise.gyro) {
    joint.topRightCorner<3, 3>() = p.block<3, 3>(Filter::kVelocity, Filter::kGyroBias);
    joint.bottomLeftCorner<3, 3>() = joint.topRightCorner<3, 3>().transpose();
    joint.bottomRightCorner<3, 3>() = p.block<3, 3>(Filter::kGyroBias, Filter::kGyroBias);
  }
  for (int i = 3; i < 6; ++i) joint(i, i) += noise.tracked;
  Covariance6 by = Covariance6::Zero();
  by.topLeftCorner<3, 3>().setIdentity();
  by.topRightCorner<3, 3>() = -cross_matrix(imu);
  by.bottomRightCorner<3, 3>() = -Matrix3d::Identity();
  Covariance6 twist = by * joint * by.transpose();
  twist.topLeftCorner<3, 3>() += (noise.variance - noise.tracked) * cross_matrix(imu) * cross_matrix(imu).transpose();
  write(twist, planar, out.twist_covariance);
  out.twist_base = planar ? Twist{{linear.x(), linear.y(), 0}, {0, 0, rate.z()}} : Twist{array(linear), array(rate)};
}

void write_learned(const ErrorStateFilter& filter, const Matrix3d& base_from_imu, StateFrame& out) noexcept {
  const auto& p = filter.covariance;
  const auto deviation = [&](int index) { return std::sqrt(std::max(0.0, p(index, index))); };
  out.gyro_bias = array(base_from_imu.transpose() * filter.gyro_bias);
  out.accelerometer_bias = array(base_from_imu.transpose() * filter.accelerometer_bias);
  const Matrix3d bias = base_from_imu.transpose() * p.block<3, 3>(Filter::kGyroBias, Filter::kGyroBias) * base_from_imu;
  out.gyro_bias_deviation = array(bias.diagonal().cwiseMax(0).cwiseSqrt());
  out.calibration = {.radius_ratio = 1 + filter.radius_ratio,
                     .wheel_base_factor = 1 + filter.wheel_base,
                     .radius_ratio_deviation = deviation(Filter::kRadiusRatio),
                     .wheel_base_deviation = deviation(Filter::kWheelBase)};
}

}  // namespace robot_control
