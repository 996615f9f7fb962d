// The estimator's state of the middle of the wheels ↔ the frame that is published: of base_link, with covariances.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimation/estimator.h"
#include "estimation/values.h"
#include "signals/rotation.h"

namespace robot_control {
namespace {

constexpr double kSpeedShare = 0.02;   // of an encoder's quantum, what the tracking loop leaves of it (speed_tracker.h)
constexpr double kUnknownBias = 2e-3;  // rad/s: 7° in a minute
constexpr std::size_t kPlane[3] = {0, 1, 5};  // x, y and yaw in a Matrix6

}  // namespace

void Estimator::fill(StateFrame& out) const noexcept {
  fill_pose(out);
  fill_twist(out);
  fill_learned(out);
  fill_health(out);
}

/// m, odom axes: from base_link to the middle of the wheels.
Planar Estimator::axle(double yaw) const noexcept {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return {c * geometry_.axle_x - s * geometry_.axle_y, s * geometry_.axle_x + c * geometry_.axle_y};
}

/// The covariance of a frame's pose, moved from base_link to the middle of the wheels.
Eigen::Matrix3d Estimator::of_middle(const StateFrame& frame) const noexcept {
  Eigen::Matrix3d known;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      known(i, j) =
          frame.pose_covariance[6 * kPlane[static_cast<std::size_t>(i)] + kPlane[static_cast<std::size_t>(j)]];
    }
  }
  const Planar lever = axle(yaw_of(frame.pose_odom.orientation));
  Eigen::Matrix3d by = Eigen::Matrix3d::Identity();
  by(0, 2) = -lever.y;
  by(1, 2) = lever.x;
  return by * known * by.transpose();
}

void Estimator::fill_pose(StateFrame& out) const noexcept {
  const Lead lead = ahead();
  PlanarPose middle = core_.pose();
  middle.yaw += lead.turn;
  middle.x += std::cos(middle.yaw) * lead.distance;
  middle.y += std::sin(middle.yaw) * lead.distance;
  const Planar lever = axle(middle.yaw);
  const Eigen::Quaterniond attitude = Eigen::AngleAxisd(middle.yaw, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(tilt_.pitch(), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(tilt_.roll(), Eigen::Vector3d::UnitX());
  out.attitude = {attitude.x(), attitude.y(), attitude.z(), attitude.w()};
  out.pose_odom.position = {middle.x - lever.x, middle.y - lever.y, parameters_.planar ? 0 : height_};
  if (placed_) {
    out.pose_odom.position[0] = (*placed_)[0];
    out.pose_odom.position[1] = (*placed_)[1];
  }
  out.pose_odom.orientation =
      parameters_.planar ? Quaternion{0, 0, std::sin(middle.yaw / 2), std::cos(middle.yaw / 2)} : out.attitude;
  fill_pose_covariance(middle.yaw, lever, out);
}

/// Probability that the clock offset is positive.
double Estimator::wheels_late() const noexcept {
  const double deviation = core_.deviation(PlanarCore::kOffset);
  if (deviation == 0) return core_.offset() > 0 ? 1 : 0;
  return std::erfc(-core_.offset() / deviation / std::numbers::sqrt2) / 2;
}

void Estimator::fill_pose_covariance(double yaw, const Planar& lever, StateFrame& out) const noexcept {
  constexpr std::size_t kStates[4] = {PlanarCore::kX, PlanarCore::kY, PlanarCore::kYaw, PlanarCore::kOffset};
  Eigen::Matrix4d states;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) states(i, j) = core_.covariance(kStates[i], kStates[j]);
  }
  Eigen::Matrix<double, 3, 4> by = Eigen::Matrix<double, 3, 4>::Identity();
  by(0, 2) = lever.y;
  by(1, 2) = -lever.x;
  const double late = wheels_late();
  const double speed = late * forward_speed();
  const double rate = resting_ ? 0 : (late - 1) * turning_;
  const Eigen::Vector3d along(std::cos(yaw), std::sin(yaw), 0);
  by.col(3) = speed * along + rate * Eigen::Vector3d(lever.y, -lever.x, 1);
  Eigen::Matrix3d known = by * states * by.transpose();
  const Eigen::Vector3d motion =
      forward_speed() * along + (resting_ ? 0 : turning_) * Eigen::Vector3d(lever.y, -lever.x, 1);
  known += square(imu_.gyro_gap()) / 8 * motion * motion.transpose();
  known += (square(encoder_) + square(forward_speed()) * jitter_.variance()) * along * along.transpose();
  if (placed_) known.setZero();
  out.pose_covariance = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      out.pose_covariance[6 * kPlane[i] + kPlane[j]] = known(static_cast<int>(i), static_cast<int>(j));
    }
  }
  // An error of u across is one of roll, of u along one of −pitch; about odom axes.
  Eigen::Matrix2d tilt;
  tilt << tilt_.covariance(1, 1), -tilt_.covariance(1, 0), -tilt_.covariance(0, 1), tilt_.covariance(0, 0);
  const Eigen::Matrix2d turned = Eigen::Rotation2Dd(yaw) * tilt * Eigen::Rotation2Dd(-yaw);
  out.attitude_covariance = {turned(0, 0), turned(0, 1), 0, turned(1, 0), turned(1, 1), 0, 0, 0, known(2, 2)};
  for (const std::size_t i : {2U, 3U, 4U}) out.pose_covariance[7 * i] = kPlanarVariance;
  if (parameters_.planar) return;
  out.pose_covariance[14] += tilt_.covariance(0, 0) * square(distance_);
  for (const std::size_t i : {0U, 1U}) {
    for (const std::size_t j : {0U, 1U}) out.pose_covariance[6 * (i + 3) + j + 3] = out.attitude_covariance[3 * i + j];
  }
}

void Estimator::fill_twist(StateFrame& out) const noexcept {
  const Eigen::Vector3d rate = resting_ ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : rate_.rate();
  const Motion velocity = geometry_.base_motion(forward_speed(), rate.z());
  const std::array<double, 2> creep = resting_ ? std::array<double, 2>{} : tyres_creep(velocity.forward);
  out.twist_base = {{velocity.forward - creep[0], velocity.left + slide_.aside() - creep[1], 0}, {0, 0, rate.z()}};
  if (!parameters_.planar) out.twist_base.angular = array(rate);
  const double quantum = std::sqrt(12.0) * encoder_ / period_;
  const double speed = std::abs(wheel_speed()) + geometry_.wheel_base / 2 * std::abs(wheel_rate());
  double wheel = square(kSpeedShare * quantum) + square(core_.slip()) * parameters_.speed_bandwidth * speed;
  double turn = core_.bias_variance() + square(parameters_.gyro_noise) / period_ * rate_noise_gain_ +
                square(parameters_.gyro_scale_deviation * rate.z());
  if (!imu_.gyro()) turn = 4 * wheel / square(geometry_.wheel_base);
  if (resting_) wheel = turn = 0;
  double forward = wheel / 2;
  double sideways = wheel / 2;
  if (slide_.active()) {
    const double changed = std::max(std::abs(slide_.excess()), std::abs(wheel_speed() - slide_.onset_speed()));
    const double off = square(changed) + square(slide_.aside());
    forward += off / 4;
    sideways += off / 4;
  }
  out.twist_covariance = {};
  out.twist_covariance[0] = forward + square(geometry_.axle_y) * turn;
  out.twist_covariance[7] =
      sideways + square(geometry_.axle_x) * turn + square(rate.z() * core_.deviation(PlanarCore::kIcr));
  out.twist_covariance[35] = turn;
  for (const std::size_t i : {14U, 21U, 28U}) out.twist_covariance[i] = kPlanarVariance;
}

void Estimator::fill_learned(StateFrame& out) const noexcept {
  const Eigen::Vector3d bias(gyro_bias_[0], gyro_bias_[1], core_.bias());
  const Eigen::Vector3d variance(gyro_variance_[0], gyro_variance_[1], core_.bias_variance());
  const Eigen::Vector3d force(tilt_.bias(0), tilt_.bias(1), tilt_.vertical_bias());
  out.gyro_bias = array(base_from_imu_.transpose() * bias);
  out.accelerometer_bias = array(base_from_imu_.transpose() * force);
  const Eigen::Matrix3d in_imu = base_from_imu_.transpose() * variance.asDiagonal() * base_from_imu_;
  out.gyro_bias_deviation = array(in_imu.diagonal().cwiseMax(0).cwiseSqrt());
  out.calibration = {.radius_ratio = 1 + core_.ratio(),
                     .wheel_base_factor = 1 + core_.base(),
                     .radius_ratio_deviation = core_.deviation(PlanarCore::kRatio),
                     .wheel_base_deviation = core_.deviation(PlanarCore::kBase)};
}

void Estimator::fill_health(StateFrame& out) const noexcept {
  out.wheels = wheels_;
  wheel_velocities_.write(out.wheel_velocity);
  out.nis = nis_;
  out.rejected = rejected_;
  out.slip = resting_ ? 0 : slide_.reasons();

  const auto confidence = [&](SensorIndex sensor, bool used) {
    out.confidence[sensor] = used ? 1 / std::max(1.0, out.nis[sensor]) : 0;
  };
  out.confidence = {};
  confidence(kLeftEncoder, sides_[kLeft].encoder.received() && !slide_.left());
  confidence(kRightEncoder, sides_[kRight].encoder.received() && !slide_.right());
  confidence(kGyro, imu_.gyro().has_value());
  confidence(kAccelerometer, imu_.accelerometer().has_value());
  confidence(kLateralContact, !slide_.sideways());
  confidence(kVerticalContact, true);

  out.flags = flags_;
  const int silent = (lost(kLeft) ? 1 : 0) + (lost(kRight) ? 1 : 0);
  if (silent == 0 || (silent == 1 && imu_.gyro())) out.flags |= kStateValid;
  if (resting_) out.flags |= lasting_flags_ & kStateStandstill;
  if (out.slip != 0) out.flags |= kStateSlip;
  out.degraded = 0;
  if (slide_.taken_back()) out.degraded |= kDegradedPosition;
  const bool unknown = core_.bias_variance() > square(kUnknownBias);
  if (!resting_ && imu_.gyro() && unknown) out.degraded |= kDegradedHeading;
  if (out.degraded != 0) out.flags |= kStateDegraded;
  out.residual_level = slip_.level();
  out.distance = distance_;
  out.skipped = skipped_;
}

}  // namespace robot_control
