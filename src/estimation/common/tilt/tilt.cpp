#include "estimation/common/tilt/tilt.h"

#include <algorithm>
#include <cmath>

#include "estimation/common/tuning.h"

namespace robot_control {

Tilt::Tilt(const TiltParams& params) noexcept : params_(params) {
  (*covariance_).diagonal().head<2>().setConstant(square(Tuning::kInitialTilt));
  (*covariance_).diagonal().tail<2>().setConstant(square(params.bias / kGravity));
}

void Tilt::bound() noexcept {
  auto up = *up_;
  if (up.norm() > 0.1) up.normalize();
  const double flat = up.head<2>().norm();
  if (flat <= Tuning::kSteepest && up[2] > 0) return;
  up.head<2>() *= Tuning::kSteepest / std::max(flat, Tuning::kSteepest);
  up[2] = std::sqrt(1 - up.head<2>().squaredNorm());
}

double Tilt::variance(int axis) const noexcept {
  const auto p = *covariance_;
  return p(axis, axis) + 2 * p(axis, axis + 2) + p(axis + 2, axis + 2);
}

Eigen::Vector2d Tilt::innovation(const Eigen::Vector2d& sum) const noexcept {
  return sum - (*up_).head<2>() - *bias_;
}

bool Tilt::contradicts(const Eigen::Vector2d& sum, double noise) const noexcept {
  const Eigen::Array2d expected(variance(0) + noise, variance(1) + noise);
  return (innovation(sum).array().square() > square(Tuning::kSignificant) * expected).any();
}

/// Applies a Kalman update by u + β, for one axis after the other.
void Tilt::update(const Eigen::Vector2d& sum, double noise) noexcept {
  auto up = *up_;
  auto p = *covariance_;
  for (const int axis : {0, 1}) {
    const Eigen::Vector4d ph = p.col(axis) + p.col(axis + 2);
    const double expected = variance(axis) + noise;
    const Eigen::Vector4d change = innovation(sum)[axis] / expected * ph;
    up.head<2>() += change.head<2>();
    *bias_ += change.tail<2>();
    p -= ph * ph.transpose() / expected;
  }
  up[2] = std::sqrt(std::max(0.1, 1 - up.head<2>().squaredNorm()));
  bound();
}

void Tilt::turn(const Vector3& rate, double dt) noexcept {
  const Eigen::Vector3d up = *up_;
  *up_ -= dt * vector(rate).cross(up);
  bound();
  turned_ += rate[2] * dt;
  time_ += dt;
}

/// Gravity turns against the robot; the bias does not.
void Tilt::age() noexcept {
  auto p = *covariance_;
  const Eigen::Matrix2d turned = Eigen::Rotation2Dd(-turned_).toRotationMatrix();
  p.topRows<2>() = (turned * p.topRows<2>()).eval();
  p.leftCols<2>() = (p.leftCols<2>() * turned.transpose()).eval();
  auto variances = p.diagonal().array();
  variances.head<2>() = (variances.head<2>() + square(Tuning::kSlowAcceleration / kGravity) * time_)
                            .min(square(Tuning::kSteepest))
                            .eval();
  variances.tail<2>() += square(params_.bias_walk / kGravity) * time_;
  turned_ = time_ = 0;
}

/// The gyro was wrong, which does not change the bias.
void Tilt::open(const Eigen::Vector2d& off) noexcept {
  (*covariance_).diagonal().head<2>().array() += off.squaredNorm();
}

void Tilt::correct(double along, double across, double dt, double deviation) noexcept {
  age();
  const Eigen::Vector2d off = Eigen::Vector2d(along, across) / kGravity, sum = (*up_).head<2>() + *bias_ + off;
  const double noise = square(deviation / kGravity) * std::max(1.0, Tuning::kSlowTime / dt);
  if (!contradicts(sum, noise)) update(sum, noise);
}

void Tilt::rest(const Vector3& force, double dt) noexcept {
  const double norm = std::hypot(force[0], force[1], force[2]);
  if (!(norm > kGravity / 2 && norm < 2 * kGravity)) return;
  age();
  const Eigen::Vector2d sum(force[0] / kGravity, force[1] / kGravity);
  const double noise = (square(params_.accelerometer) / dt + square(Tuning::kSlowAcceleration)) / square(kGravity);
  if (contradicts(sum, noise)) open(innovation(sum));
  update(sum, noise);
  vertical_ += std::min(1.0, dt) * (norm - kGravity - vertical_);
}

void Tilt::set(const Vector3& up, const std::array<double, 2>& bias) noexcept {
  *up_ = vector(up);
  *bias_ = Eigen::Vector2d(bias[0], bias[1]) / kGravity;
  bound();
}

/// The half-angle formulas hold because neither angle exceeds kSteepest.
Eigen::Quaterniond Tilt::attitude() const noexcept {
  const auto up = *up_;
  const double cos_pitch = std::sqrt(square(up[1]) + square(up[2]));
  const double half_roll = std::sqrt((1 + up[2] / cos_pitch) / 2);  // cosine of half the angle
  const double half_pitch = std::sqrt((1 + cos_pitch) / 2);
  return Eigen::Quaterniond(half_pitch, 0, -up[0] / (2 * half_pitch), 0) *
         Eigen::Quaterniond(half_roll, up[1] / (2 * half_roll * cos_pitch), 0, 0);
}

}  // namespace robot_control
