#include "estimation/tilt/tilt.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "estimation/tuning.h"

namespace robot_control {

Tilt::Tilt(const TiltParams& params) noexcept : params_(params) {
  now_.covariance.diagonal().head<2>().setConstant(square(Tuning::kInitialTilt));
  now_.covariance.diagonal().tail<2>().setConstant(square(params.bias / kGravity));
}

void Tilt::Estimate::bound() noexcept {
  if (up.norm() > 0.1) up.normalize();
  const double flat = up.head<2>().norm();
  if (flat <= Tuning::kSteepest && up[2] > 0) return;
  up.head<2>() *= Tuning::kSteepest / std::max(flat, Tuning::kSteepest);
  up[2] = std::sqrt(1 - up.head<2>().squaredNorm());
}

/// Gravity turns against the robot; the bias does not.
void Tilt::Estimate::turn(double angle) noexcept {
  const Eigen::Matrix2d turned = Eigen::Rotation2Dd(-angle).toRotationMatrix();
  covariance.topRows<2>() = (turned * covariance.topRows<2>()).eval();
  covariance.leftCols<2>() = (covariance.leftCols<2>() * turned.transpose()).eval();
}

double Tilt::Estimate::variance(int axis) const noexcept {
  return covariance(axis, axis) + 2 * covariance(axis, axis + 2) + covariance(axis + 2, axis + 2);
}

bool Tilt::Estimate::contradicts(const Eigen::Vector2d& sum, double noise) const noexcept {
  const Eigen::Vector2d bound =
      square(Tuning::kSignificant) * Eigen::Vector2d(variance(0) + noise, variance(1) + noise);
  return (innovation(sum).array().square() > bound.array()).any();
}

/// Applies a Kalman update by u + β, for one axis after the other.
void Tilt::Estimate::update(const Eigen::Vector2d& sum, double noise) noexcept {
  for (const int axis : {0, 1}) {
    const Eigen::Vector4d ph = covariance.col(axis) + covariance.col(axis + 2);
    const double expected = variance(axis) + noise;
    const Eigen::Vector4d change = innovation(sum)[axis] / expected * ph;
    up.head<2>() += change.head<2>();
    bias += change.tail<2>();
    covariance -= ph * ph.transpose() / expected;
  }
  up[2] = std::sqrt(std::max(0.1, 1 - up.head<2>().squaredNorm()));
  bound();
}

void Tilt::turn(const Vector3& rate, double dt, bool known) noexcept {
  const Eigen::Vector3d w(rate.data());
  now_.up -= dt * w.cross(now_.up);
  now_.bound();
  unreliable_ += std::max(0.0, w.head<2>().norm() - Tuning::kTipping) * dt;
  stuck_ = known && rate == last_ ? stuck_ + dt : 0;
  if (stuck_ > Tuning::kMaxHoldTime) unreliable_ = std::max(unreliable_, Tuning::kFloor);
  last_ = rate;
  turned_ += rate[2] * dt;
  time_ += dt;
}

void Tilt::age() noexcept {
  now_.turn(turned_);
  auto variances = now_.covariance.diagonal().array();
  variances.head<2>() = (variances.head<2>() + square(Tuning::kSlowAcceleration / kGravity) * time_)
                            .min(square(Tuning::kSteepest))
                            .eval();
  variances.tail<2>() += square(params_.bias_walk / kGravity) * time_;
  turned_ = time_ = 0;
}

void Tilt::correct(double along, double across, double dt, double deviation) noexcept {
  age();
  const Eigen::Vector2d sum = now_.up.head<2>() + now_.bias + Eigen::Vector2d(along, across) / kGravity;
  now_.update(sum, square(deviation / kGravity) * std::max(1.0, Tuning::kSlowTime / dt));
}

Tilt::Estimate Tilt::on_the_floor() const noexcept {
  Estimate floor = rested_;
  floor.up.head<2>() = Eigen::Rotation2Dd(-rolled_) * rested_.up.head<2>();
  floor.turn(rolled_);
  floor.covariance.diagonal().head<2>().array() += square(Tuning::kFloor);
  return floor;
}

void Tilt::rest(const Vector3& force, double dt) noexcept {
  const double norm = std::hypot(force[0], force[1], force[2]);
  if (!(norm > kGravity / 2 && norm < 2 * kGravity)) return;
  age();
  const Eigen::Vector2d sum(force[0] / kGravity, force[1] / kGravity);
  const double noise = (square(params_.accelerometer) / dt + square(Tuning::kAccelerometerAtRest)) / square(kGravity);
  const bool by_gyro = unreliable_ < Tuning::kFloor && !now_.contradicts(sum, noise);
  if (!by_gyro && has_rested_) now_ = on_the_floor();
  if (now_.contradicts(sum, noise)) {
    now_.covariance.diagonal().head<2>().array() += now_.innovation(sum).squaredNorm();
  }
  now_.update(sum, noise);
  vertical_ += std::min(1.0, dt) * (norm - kGravity - vertical_);
  rested_ = now_;
  has_rested_ = true;
  rolled_ = unreliable_ = 0;
}

void Tilt::set(const Vector3& up, const std::array<double, 2>& bias) noexcept {
  now_.up = Eigen::Vector3d(up.data());
  now_.bias = Eigen::Vector2d(bias.data()) / kGravity;
  now_.bound();
}

double Tilt::roll() const noexcept {
  return std::atan2(now_.up[1], now_.up[2]);
}

double Tilt::pitch() const noexcept {
  return std::asin(std::clamp(-now_.up[0], -1.0, 1.0));
}

}  // namespace robot_control
