// The nominal state and how it is predicted.

#include "estimation/filter/error_state_filter.h"

#include <algorithm>
#include <cmath>

#include "estimation/filter/algebra.h"

namespace robot_control {
namespace {

using namespace algebra;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMaxRatio = 0.05;  // wheels of one type differ by less than a tenth of it
constexpr double kMaxBase = 0.3;    // of a skid-steer on another floor

}  // namespace

ErrorStateFilter::ErrorStateFilter(const ContactGeometry& geometry, const FilterNoise& noise, const FilterPrior& prior)
    : geometry_(geometry), noise_(noise), prior_(prior) {
  reset();
}

void ErrorStateFilter::reset() noexcept {
  position = geometry_.imu_in_base;
  rotation.setIdentity();
  velocity.setZero();
  travel.setZero();
  gyro_bias.setZero();
  accelerometer_bias.setZero();
  rate.setZero();
  smooth_rate = slow_rate = 0;
  radius_ratio = wheel_base = gyro_scale = 0;
  force.setZero();
  corrections_.setZero();
  covariance.setZero();
  const auto prior = [&](int index, double deviation) { covariance(index, index) = square(deviation); };
  for (const int i : {0, 1}) prior(kOrientation + i, prior_.tilt);
  for (const int i : {0, 1, 2}) prior(kGyroBias + i, prior_.gyro_bias);
  for (const int i : {0, 1, 2}) prior(kAccelerometerBias + i, prior_.accelerometer_bias);
  for (const int i : {0, 1}) prior(kTravel + i, noise_.encoder);
  prior(kRadiusRatio, prior_.radius_ratio);
  prior(kWheelBase, prior_.wheel_base);
  prior(kGyroScale, prior_.gyro_scale);
}

double ErrorStateFilter::lever(int side) const noexcept {
  return geometry_.middle_y + (side == 0 ? 0.5 : -0.5) * geometry_.wheel_base * (1 + wheel_base);
}

double ErrorStateFilter::tread_speed(int side, const Vector3d& u, const Vector3d& omega) const noexcept {
  const double contact = u.x() + omega.y() * geometry_.height - omega.z() * lever(side);
  return contact + geometry_.creep * std::abs(contact) * force.x();
}

double ErrorStateFilter::creep_across() const noexcept {
  const double speed = velocity.x() + rate.y() * geometry_.height - rate.z() * geometry_.middle_y;
  return -geometry_.creep * std::abs(speed) * force.y();
}

Vector2d ErrorStateFilter::force_on_tyres(const Vector3d& accelerometer) const noexcept {
  const Vector2d doubtful = kGravity * (1 - significant_tilt()) * rotation.row(2).head<2>().transpose();
  const Vector2d swung = square(smooth_rate) * Vector2d(geometry_.middle_x, geometry_.middle_y);
  const Vector2d felt = (accelerometer - accelerometer_bias).head<2>() - doubtful - swung;
  return felt.cwiseMax(-kGravity).cwiseMin(kGravity);
}

double ErrorStateFilter::significant_tilt() const noexcept {
  const double tilt = rotation.row(2).head<2>().norm();
  const double uncertainty =
      3 * std::sqrt(covariance(kOrientation, kOrientation) + covariance(kOrientation + 1, kOrientation + 1));
  return tilt > uncertainty ? 1 - uncertainty / tilt : 0;
}

void ErrorStateFilter::predict(const Motion& motion) noexcept {
  const double dt = motion.dt;
  Vector3d omega{0, 0, 0};
  if (motion.gyro) {
    omega = (1 + gyro_scale) * (*motion.gyro - gyro_bias);
  } else {
    const double turn = (1 + radius_ratio / 2) * motion.right_travel - (1 - radius_ratio / 2) * motion.left_travel;
    omega.z() = turn / (geometry_.wheel_base * (1 + wheel_base)) / dt;
  }
  const Matrix3d half = exponential(omega * (dt / 2));
  const Matrix3d turn = half * half;
  const Matrix3d middle = rotation * half;
  const Vector3d gravity{0, 0, -kGravity};
  Vector3d u = velocity;
  if (motion.accelerometer) {
    const Vector3d steady = *motion.accelerometer - accelerometer_bias + middle.transpose() * gravity;
    u = half.transpose() * velocity + dt / 2 * steady;
    velocity = turn.transpose() * velocity + dt * (half.transpose() * steady);
  }
  smooth_rate += dt / (kSmoothing + dt) * (omega.z() - smooth_rate);
  slow_rate += dt / (kWindUp + dt) * (smooth_rate - slow_rate);
  force = motion.accelerometer ? force_on_tyres(*motion.accelerometer) : Vector2d::Zero();
  transport(motion, middle, turn, u, omega);

  position += dt * (middle * u);
  const double scale[2] = {1 / (1 - radius_ratio / 2), 1 / (1 + radius_ratio / 2)};
  for (const int side : {0, 1}) travel[side] += dt * scale[side] * tread_speed(side, u, omega);
  rotation = rotation * turn;
  orthonormalise(rotation);
  rate = omega;
  corrections_.setZero();
}

/// P ← F P Fᵀ + Q. F = I + dt·A is sparse: F P Fᵀ is two passes of column operations with a transposition between. The
/// velocity is turned exactly: I − dt [ω]× would let it grow without bound where a gyro reads nonsense.
void ErrorStateFilter::transport(const Motion& motion, const Matrix3d& middle, const Matrix3d& turn, const Vector3d& u,
                                 const Vector3d& omega) noexcept {
  const double dt = motion.dt;
  const bool gyro = motion.gyro.has_value();
  const Vector3d speed = middle * u;
  const Matrix3d by_tilt = dt * middle.transpose() * cross_matrix({0, 0, -kGravity});
  const Vector3d turning = dt * omega.cross(u);
  const Vector3d axes[3] = {dt * middle.col(0), dt * middle.col(1), dt * middle.col(2)};
  const double scale[2] = {dt / (1 - radius_ratio / 2), dt / (1 + radius_ratio / 2)};
  const double height = geometry_.height;
  const double base = geometry_.wheel_base * (1 + wheel_base);
  const double bias = std::sqrt(covariance(kGyroBias + 2, kGyroBias + 2));
  const double still = kTurns * noise_.gyro / std::sqrt(2 * (kSmoothing + kWindUp)) + 3 * bias;
  const double turn_rate = std::abs(slow_rate) > still ? slow_rate : 0;
  double contact[2];
  for (const int side : {0, 1}) contact[side] = u.x() - turn_rate * lever(side);

  const auto pass = [&](Covariance& p) {
    for (const int i : {0, 1, 2}) {  // position
      p.col(kPosition + i) +=
          axes[0][i] * p.col(kVelocity) + axes[1][i] * p.col(kVelocity + 1) + axes[2][i] * p.col(kVelocity + 2);
    }
    p.col(kPosition) += dt * (speed.z() * p.col(kOrientation + 1) - speed.y() * p.col(kOrientation + 2));
    p.col(kPosition + 1) += dt * (speed.x() * p.col(kOrientation + 2) - speed.z() * p.col(kOrientation));
    p.col(kPosition + 2) += dt * (speed.y() * p.col(kOrientation) - speed.x() * p.col(kOrientation + 1));
    for (const int side : {0, 1}) {  // travel
      auto column = p.col(kTravel + side);
      const double sign = side == 0 ? 0.5 : -0.5;
      column += scale[side] * p.col(kVelocity);
      if (!gyro) continue;  // the turn is the wheels' own: a wrong ratio turns the robot, and contradicts no encoder
      column += scale[side] * sign * contact[side] * p.col(kRadiusRatio);
      column += scale[side] * (lever(side) * p.col(kGyroBias + 2) - height * p.col(kGyroBias + 1));
      column -= scale[side] * turn_rate * sign * geometry_.wheel_base * p.col(kWheelBase);
      column -= scale[side] * turn_rate * lever(side) * p.col(kGyroScale);
    }
    if (motion.accelerometer) {  // velocity
      const Column x = p.col(kVelocity);
      const Column y = p.col(kVelocity + 1);
      const Column z = p.col(kVelocity + 2);
      const auto g = [&](int i) { return p.col(kGyroBias + i); };
      p.col(kVelocity) = turn(0, 0) * x + turn(1, 0) * y + turn(2, 0) * z - dt * p.col(kAccelerometerBias);
      p.col(kVelocity + 1) = turn(0, 1) * x + turn(1, 1) * y + turn(2, 1) * z - dt * p.col(kAccelerometerBias + 1);
      p.col(kVelocity + 2) = turn(0, 2) * x + turn(1, 2) * y + turn(2, 2) * z - dt * p.col(kAccelerometerBias + 2);
      for (const int i : {0, 1, 2}) {
        p.col(kVelocity + i) += by_tilt(i, 0) * p.col(kOrientation) + by_tilt(i, 1) * p.col(kOrientation + 1);
      }
      if (gyro) {
        p.col(kVelocity) += dt * (u.z() * g(1) - u.y() * g(2)) - turning.x() * p.col(kGyroScale);
        p.col(kVelocity + 1) += dt * (u.x() * g(2) - u.z() * g(0)) - turning.y() * p.col(kGyroScale);
        p.col(kVelocity + 2) += dt * (u.y() * g(0) - u.x() * g(1)) - turning.z() * p.col(kGyroScale);
      }
    }
    const Vector3d turned = dt * (middle * omega);
    for (const int i : {0, 1, 2}) {  // orientation
      auto column = p.col(kOrientation + i);
      if (gyro) {
        column -= axes[0][i] * p.col(kGyroBias) + axes[1][i] * p.col(kGyroBias + 1) + axes[2][i] * p.col(kGyroBias + 2);
        column += turned[i] * p.col(kGyroScale);
      } else {
        const double mean = (motion.left_travel + motion.right_travel) / 2;
        column += middle(i, 2) * (mean / base * p.col(kRadiusRatio)) - turned[i] * p.col(kWheelBase);
      }
    }
  };
  pass(covariance);
  covariance.transposeInPlace();
  pass(covariance);

  Covariance& p = covariance;
  if (gyro) {  // noise of the gyro moves orientation, velocity and travel together, as its bias does
    const double variance = square(noise_.gyro) / dt;
    for (const int axis : {0, 1, 2}) {
      Eigen::Matrix<double, 8, 1> g = Eigen::Matrix<double, 8, 1>::Zero();
      g.head<3>() = -axes[axis];
      g.segment<3>(3) = -dt * u.cross(Vector3d::Unit(axis));
      if (axis == 2) g.tail<2>() << scale[0] * lever(0), scale[1] * lever(1);
      if (axis == 1) g.tail<2>() << -scale[0] * height, -scale[1] * height;
      p.block<8, 8>(kOrientation, kOrientation) += variance * g * g.transpose();
    }
  } else {
    constexpr double kLevel = 0.02;  // rad/√s: how a floor that is about even tilts the robot
    const double path = (std::abs(motion.left_speed) + std::abs(motion.right_speed)) * dt;
    const double yaw = square(noise_.wheel_slip / base) * path;
    p(kOrientation, kOrientation) += square(kLevel) * dt;
    p(kOrientation + 1, kOrientation + 1) += square(kLevel) * dt;
    p(kOrientation + 2, kOrientation + 2) += yaw;
  }
  const double known = noise_.accelerometer + (motion.sliding ? kSliding : 0);
  const double shake = square(motion.accelerometer ? known : kUnknownAcceleration) * dt;
  for (const int i : {0, 1, 2}) p(kVelocity + i, kVelocity + i) += shake;
  age(dt);
  const double path = (std::abs(motion.left_speed) + std::abs(motion.right_speed)) / 2 * dt;
  const double slope = significant_tilt() * rotation.row(2).head<2>().norm();
  const double slip = square(noise_.wheel_slip) + square(noise_.slope_slip * slope);
  p(kTravel, kTravel) += slip * std::abs(motion.left_speed) * dt;
  p(kTravel + 1, kTravel + 1) += slip * std::abs(motion.right_speed) * dt;
  const double common = noise_.common_slip * (1 + kCautious * motion.slip_proximity);
  p.block<2, 2>(kTravel, kTravel).array() += (square(common) + square(noise_.slope_creep * slope)) * path;
  const double wound = std::abs(smooth_rate - slow_rate) / kWindUp;
  const double twist =
      square(base / 2) * (square(noise_.turn_slip) * std::abs(omega.z()) + square(noise_.wind_up) * wound) * dt;
  p.block<2, 2>(kTravel, kTravel) += Eigen::Matrix2d{{twist, -twist}, {-twist, twist}};
  if (p(kRadiusRatio, kRadiusRatio) > 0) p(kRadiusRatio, kRadiusRatio) += square(noise_.radius_ratio_walk) * path;
  if (p(kWheelBase, kWheelBase) > 0) p(kWheelBase, kWheelBase) += square(noise_.wheel_base_walk) * path;
  // No measurement shrinks an asymmetric part: of rounding alone it would outgrow the covariance within an hour's
  // drive.
  for (int i = 1; i < kSize; ++i) {
    for (int j = 0; j < i; ++j) p(i, j) = p(j, i);
  }
}

void ErrorStateFilter::inject(const Column& error) noexcept {
  position += error.segment<3>(kPosition);
  rotation = exponential(error.segment<3>(kOrientation)) * rotation;
  velocity += error.segment<3>(kVelocity);
  travel += error.segment<2>(kTravel);
  gyro_bias += error.segment<3>(kGyroBias);
  accelerometer_bias += error.segment<3>(kAccelerometerBias);
  radius_ratio = std::clamp(radius_ratio + error[kRadiusRatio], -kMaxRatio, kMaxRatio);
  wheel_base = std::clamp(wheel_base + error[kWheelBase], -kMaxBase, kMaxBase);
  gyro_scale = std::clamp(gyro_scale + error[kGyroScale], -kMaxRatio, kMaxRatio);
}

void ErrorStateFilter::inflate_position(int axis, double deviation) noexcept {
  const Vector3d along = rotation.col(axis) * deviation;
  covariance.block<3, 3>(kPosition, kPosition) += along * along.transpose();
}

void ErrorStateFilter::inflate_velocity(int axis, double deviation, double time) noexcept {
  Column error = Column::Zero();
  error[kVelocity + axis] = deviation;
  error.segment<3>(kPosition) = rotation.col(axis) * (deviation * time / 2);
  covariance.noalias() += error * error.transpose();
  const int bias = kAccelerometerBias + axis;
  covariance(bias, bias) += square(kPulledBias);
}

void ErrorStateFilter::age(double dt) noexcept {
  for (const int i : {0, 1, 2}) {
    covariance(kGyroBias + i, kGyroBias + i) += square(noise_.gyro_bias_walk) * dt;
    covariance(kAccelerometerBias + i, kAccelerometerBias + i) += square(noise_.accelerometer_bias_walk) * dt;
  }
}

void ErrorStateFilter::anchor_travel(int side, double measured) noexcept {
  const int index = kTravel + side;
  travel[side] = measured;
  covariance.col(index).setZero();
  covariance.row(index).setZero();
  covariance(index, index) = square(noise_.encoder);
}

void ErrorStateFilter::turn_by(const Vector3d& angle) noexcept {
  rotation = rotation * exponential(angle);
}

}  // namespace robot_control
