// This file converts the estimator's state of the middle of the wheels to the published frame of base_link.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimation/common/values.h"
#include "estimation/wheeled/estimator.h"
#include "signals/rotation.h"

namespace robot_control {
namespace {

const std::array<int, 3> kPlane{0, 1, 5};  // x, y and yaw in a Matrix6
using PoseMatrix = Eigen::Matrix<double, 6, 6>;

}  // namespace

void Estimator::fill(const SensorFrame& sensors, StateFrame& out) const noexcept {
  fill_pose(out.base);
  fill_twist(out.base);
  fill_learned(out);
  fill_health(out);
  const auto joints = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(sensors.joint_count, kMaxJoints));
  std::transform(sensors.joints.begin(), sensors.joints.begin() + joints, out.joint_velocity.begin(), valid_velocity);
  state_.wheel_sides.write(out.joint_velocity);
  wheel_slip_.write(out);
}

void Estimator::fill_pose(BaseState& base) const noexcept {
  const Prediction ahead = prediction();
  PlanarPose middle = state_.core.shown_pose();
  middle.yaw += ahead.turn;
  const Turn yaw(middle.yaw);
  middle.x += yaw.cos * ahead.distance;
  middle.y += yaw.sin * ahead.distance;
  const Planar lever = axle(yaw);
  const Eigen::Quaterniond turn(std::cos(middle.yaw / 2), 0, 0, std::sin(middle.yaw / 2));
  const Eigen::Quaterniond attitude = turn * state_.tilt.attitude();
  base.attitude = {attitude.x(), attitude.y(), attitude.z(), attitude.w()};
  base.pose_odom.position = {middle.x - lever.x, middle.y - lever.y, parameters_.planar ? 0 : state_.height};
  if (state_.pose_set) std::copy_n(state_.pose_set->begin(), 2, base.pose_odom.position.begin());
  base.pose_odom.orientation = parameters_.planar ? Quaternion{0, 0, turn.z(), turn.w()} : base.attitude;
  fill_pose_covariance(yaw, lever, base);
}

///   P = J P_core Jᵀ + m mᵀ p (1 − p) σ_τ² + a aᵀ σ_encoder²
/// J is the Jacobian by clock offset τ, x, y and yaw. The direction of travel is a, the velocity of base_link is m. The
/// wheels are late with the probability p, which leaves the position behind. Otherwise the gyro is, which leaves the
/// yaw behind.
void Estimator::fill_pose_covariance(const Turn& yaw, const Planar& lever, BaseState& base) const noexcept {
  const double late = late_wheels();
  const double yaw_rate = state_.rest.resting() ? 0 : state_.yaw_rate;
  const Eigen::Vector3d along(yaw.cos, yaw.sin, 0);
  const Eigen::Vector3d turning(lever.y, -lever.x, 1);
  Eigen::Matrix<double, 3, 4> jacobian;
  jacobian << late * forward_speed() * along + (late - 1) * yaw_rate * turning, Eigen::Vector3d::UnitX(),
      Eigen::Vector3d::UnitY(), turning;
  const Eigen::Matrix4d states = state_.core.pose_covariance();
  Eigen::Matrix3d covariance = jacobian * states * jacobian.transpose();
  const Eigen::Vector3d motion = forward_speed() * along + yaw_rate * turning;
  covariance += late * (1 - late) * states(0, 0) * motion * motion.transpose();
  covariance += square(encoder_) * along * along.transpose();
  covariance.diagonal() += square(state_.wheels.unknown_speed() * state_.wheels.lost_time) *
                           Eigen::Vector3d(1, 1, state_.imu.gyro ? 0 : 4 / square(geometry_.wheel_base));
  if (state_.pose_set) covariance.setZero();
  Eigen::Map<PoseMatrix> published(base.pose_covariance.data());
  published = Tuning::kPlanarVariance * PoseMatrix::Identity();
  published(kPlane, kPlane) = covariance;
  fill_attitude_covariance(yaw, covariance(2, 2), base);
}

/// Returns the probability that the wheels are late, not the gyro.
double Estimator::late_wheels() const noexcept {
  const double deviation = state_.core.deviation(PlanarCore::kOffset);
  return deviation > 0 ? std::erfc(-state_.core.offset() / deviation * std::numbers::sqrt2 / 2) / 2 : 1;
}

/// An error of u across is an error of roll, and an error of u along is one of −pitch. Both are turned to odom axes.
void Estimator::fill_attitude_covariance(const Turn& yaw, double yaw_variance, BaseState& base) const noexcept {
  Eigen::Matrix2d tilt;
  tilt << state_.tilt.covariance(1, 1), -state_.tilt.covariance(1, 0), -state_.tilt.covariance(0, 1),
      state_.tilt.covariance(0, 0);
  const Eigen::Matrix2d turned{{yaw.cos, -yaw.sin}, {yaw.sin, yaw.cos}};
  tilt = (turned * tilt * turned.transpose()).eval();
  base.attitude_covariance = {tilt(0, 0), tilt(0, 1), 0, tilt(1, 0), tilt(1, 1), 0, 0, 0, yaw_variance};
  if (parameters_.planar) return;
  base.pose_covariance[14] += state_.tilt.covariance(0, 0) * square(state_.distance);
  for (const std::size_t i : {0U, 1U}) {
    for (const std::size_t j : {0U, 1U}) base.pose_covariance[6 * i + j + 21] = base.attitude_covariance[3 * i + j];
  }
}

void Estimator::fill_twist(BaseState& base) const noexcept {
  const Eigen::Vector3d rate = state_.rest.resting() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : state_.rate.rate();
  const Motion velocity = geometry_.base_motion(forward_speed(), rate.z());
  const Planar creep = state_.rest.resting() ? Planar{} : tyres_creep(velocity.forward);
  base.twist_base = {{velocity.forward - creep.x, velocity.left - creep.y, 0}, {0, 0, rate.z()}};
  if (!parameters_.planar) base.twist_base.angular = array(rate);
  fill_twist_covariance(rate.z(), base);
}

void Estimator::fill_twist_covariance(double yaw_rate, BaseState& base) const noexcept {
  const double quantum = std::sqrt(12.0) * encoder_ / period_;
  const double speed = std::abs(state_.wheels.mean_speed()) + geometry_.wheel_base / 2 * std::abs(wheel_rate());
  double wheel = square(Tuning::kSpeedShare * quantum) + 2 * square(state_.wheels.unknown_speed()) +
                 square(state_.core.slip()) * parameters_.speed_bandwidth * speed;
  double turn = state_.core.bias_variance() + square(parameters_.gyro_noise) / period_ * state_.rate.noise_gain() +
                square(parameters_.gyro_scale_deviation * yaw_rate);
  if (!state_.imu.gyro) turn = 4 * wheel / square(geometry_.wheel_base);
  if (state_.imu.gyro && !state_.wheels.any_lost()) {
    const double by_wheels = state_.core.wheel_turn(state_.wheels.speed[kLeft], state_.wheels.speed[kRight]);
    const double apart = square(by_wheels - yaw_rate);
    if (apart > square(Tuning::kSignificant) * turn) turn = apart;
  }
  if (state_.rest.resting()) wheel = turn = 0;
  const double slides = state_.slip.slips() ? square(state_.slip.speed_deviation()) : 0;
  base.twist_covariance = {};
  base.twist_covariance[0] = wheel / 2 + slides + square(parameters_.wheel_radius_deviation * forward_speed()) +
                             square(geometry_.axle[1]) * turn;
  base.twist_covariance[7] = wheel / 2 + slides + square(geometry_.axle[0]) * turn +
                             square(yaw_rate * state_.core.deviation(PlanarCore::kIcr));
  base.twist_covariance[35] = turn;
  for (const std::size_t i : {14U, 21U, 28U}) base.twist_covariance[i] = Tuning::kPlanarVariance;
}

void Estimator::fill_learned(StateFrame& out) const noexcept {
  const Eigen::Matrix3d imu_from_base = base_from_imu_.transpose();
  const Eigen::Vector3d force(state_.tilt.bias(0), state_.tilt.bias(1), state_.tilt.vertical_bias());
  const Eigen::Matrix3d bias_covariance = imu_from_base * gyro_bias_variance().asDiagonal() * base_from_imu_;
  out.base.gyro_bias = array(imu_from_base * gyro_bias());
  out.base.gyro_bias_deviation = array(bias_covariance.diagonal().cwiseMax(0).cwiseSqrt());
  out.base.accelerometer_bias = array(imu_from_base * force);
  out.wheeled.calibration = state_.core.calibration();
}

void Estimator::fill_health(StateFrame& out) const noexcept {
  out.wheeled.odometry = state_.wheel_odometry;
  out.wheeled.nis = state_.nis;
  out.wheeled.rejected = state_.rejected;
  out.wheeled.slip = state_.slip.reasons();
  out.wheeled.residual_level = state_.slip.level();
  out.base.distance = state_.distance;
  out.skipped = state_.skipped;
  const auto confidence = [&](SensorIndex sensor, bool used) {
    out.wheeled.confidence[sensor] = used ? 1 / std::max(1.0, out.wheeled.nis[sensor]) : 0;
  };
  confidence(kLeftEncoder, state_.wheels.received[kLeft] && !state_.slip.slips());
  confidence(kRightEncoder, state_.wheels.received[kRight] && !state_.slip.slips());
  confidence(kGyro, state_.imu.gyro.has_value());
  confidence(kAccelerometer, state_.imu.accelerometer.has_value());
  confidence(kLateralContact, true);
  confidence(kVerticalContact, true);
  out.base.flags = state_.flags;
  if (!state_.wheels.any_lost() || (!state_.wheels.both_lost() && state_.imu.gyro)) out.base.flags |= kStateValid;
  if (state_.rest.standing()) out.base.flags |= kStateStandstill;
  if (state_.restarted) out.base.flags |= kStateRestarted;
  if (out.wheeled.slip != 0) out.base.flags |= kStateSlip;
  out.base.degraded = 0;
  if (state_.slip.slips()) out.base.degraded |= kDegradedPosition;
  if (state_.core.contradicted()) out.base.degraded |= kDegradedHeading;
  const bool unknown_bias = state_.core.bias_variance() > square(Tuning::kUnknownBias);
  if (!state_.rest.resting() && state_.imu.gyro && unknown_bias) out.base.degraded |= kDegradedHeading;
  if (out.base.degraded != 0) out.base.flags |= kStateDegraded;
}

}  // namespace robot_control
