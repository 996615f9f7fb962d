// What measurements correct, and what they leave as it is.

#include <algorithm>
#include <cmath>

#include "estimation/filter/algebra.h"
#include "estimation/filter/error_state_filter.h"

namespace robot_control {
namespace {

using namespace algebra;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Filter = ErrorStateFilter;

// What a correction considers and does not correct: parts of one list. An uneven floor breaks the vertical contact all
// the time.
constexpr int kStill[] = {Filter::kPosition, Filter::kPosition + 1, Filter::kPosition + 2, Filter::kOrientation + 2,
                          // from here on, by wheels that slide
                          Filter::kOrientation, Filter::kOrientation + 1, Filter::kAccelerometerBias,
                          Filter::kAccelerometerBias + 1, Filter::kAccelerometerBias + 2, Filter::kGyroScale,
                          // to here, by wheels that roll
                          Filter::kGyroBias, Filter::kGyroBias + 1, Filter::kGyroBias + 2, Filter::kRadiusRatio,
                          Filter::kWheelBase};
constexpr std::span<const int> kNotByTheVertical = kStill;
constexpr std::span<const int> kNotBySliding = kNotByTheVertical.subspan(4);
constexpr std::span<const int> kNotByRolling = kNotBySliding.first(6);
constexpr std::span<const int> kNotByAWindow = kNotByTheVertical.first(4);
constexpr std::span<const int> kNotAtRest = kNotByAWindow.last(1);

constexpr double kHuber = 1.5;          // σ: 96 % efficient where the noise is normal
constexpr double kTravelSlack = 0.002;  // m: a reading that is less wrong is no outlier; sliding, the slip watch sees
constexpr double kGate = 16.0;          // 4 σ of one degree of freedom: one good sample in 16 000 is refused

/// What θ_x and θ_y make of gravity along the base axis whose direction in odom is `axis`: (Rᵀ [g]×) of that row.
Vector2d acceleration_by_tilt(const Vector3d& axis) noexcept {
  return {-Filter::kGravity * axis.y(), Filter::kGravity * axis.x()};
}

}  // namespace

/// What is considered is not corrected (S. F. Schmidt, Application of state-space methods to navigation problems,
/// 1966): its part of the gain is zero, which leaves the block of its own covariance as it was.
ErrorStateFilter::Innovation ErrorStateFilter::correct(const Column& ph, double innovation, double variance,
                                                       std::span<const int> considered) noexcept {
  const Column root = ph / std::sqrt(variance);
  covariance.noalias() -= root * root.transpose();
  Column error = ph * (innovation / variance);
  for (const int i : considered) {
    for (const int j : considered) covariance(i, j) += root[i] * root[j];
    error[i] = 0;
  }
  inject(error);
  corrections_ += error;
  return {innovation * innovation / variance, true};
}

/// The gain of the position is that of the orientation on the lever from base_link to the IMU; what a gain other than
/// Kalman's costs, the covariance gets (Y. Bar-Shalom et al., 2001, section 5.2.3: Joseph's form).
ErrorStateFilter::Innovation ErrorStateFilter::learn(const Column& ph, double innovation, double variance,
                                                     std::span<const int> considered) noexcept {
  Column gain = ph / variance;
  for (const int i : considered) gain[i] = 0;
  gain.segment<3>(kPosition) = gain.segment<3>(kOrientation).cross(rotation * geometry_.imu_in_base);
  const Column root = ph / std::sqrt(variance);
  const Column missed = gain * std::sqrt(variance) - root;
  covariance.noalias() -= root * root.transpose();
  covariance.noalias() += missed * missed.transpose();
  const Column error = gain * innovation;
  inject(error);
  corrections_ += error;
  return {innovation * innovation / variance, true};
}

ErrorStateFilter::Innovation ErrorStateFilter::correct_rolling(const Column& ph, double innovation, double variance,
                                                               double slack, std::span<const int> considered) noexcept {
  const double nis = innovation * innovation / variance;
  if (!(innovation * innovation <= kGate * (variance + slack))) return {nis, false};
  // Huber's weight: what is beyond kHuber deviations pulls no harder (P. J. Huber, Robust Statistics, 1981, chapter 3).
  correct(ph, innovation, variance * std::max(1.0, std::sqrt(nis) / kHuber), considered);
  return {nis, true};
}

ErrorStateFilter::Innovation ErrorStateFilter::correct_travel(int side, double measured, Scope scope) noexcept {
  const Column ph = covariance.col(kTravel + side);
  return correct_rolling(ph, measured - travel[side], ph[kTravel + side] + square(noise_.encoder), square(kTravelSlack),
                         scope == Scope::kAll ? kNotByRolling : kNotBySliding);
}

ErrorStateFilter::Innovation ErrorStateFilter::correct_lateral(double dt) noexcept {
  const double x = geometry_.middle_x;
  const double z = geometry_.height;
  const double speed = velocity.y() + rate.z() * x - rate.x() * z - creep_across();
  const Column ph = covariance.col(kVelocity + 1) - x * covariance.col(kGyroBias + 2) + z * covariance.col(kGyroBias);
  const double own = ph[kVelocity + 1] - x * ph[kGyroBias + 2] + z * ph[kGyroBias];
  const double noise = square(noise_.lateral) / dt + square(noise_.gyro) / dt * (x * x + z * z);
  return correct_rolling(ph, -speed, own + noise, 0, kNotByRolling);
}

ErrorStateFilter::Innovation ErrorStateFilter::correct_vertical(double dt) noexcept {
  const double x = geometry_.middle_x;
  const double y = geometry_.middle_y;
  const double speed = velocity.z() + rate.x() * y - rate.y() * x;
  const Column ph = covariance.col(kVelocity + 2) - y * covariance.col(kGyroBias) + x * covariance.col(kGyroBias + 1);
  const double own = ph[kVelocity + 2] - y * ph[kGyroBias] + x * ph[kGyroBias + 1];
  const double noise = square(noise_.vertical) / dt + square(noise_.gyro) / dt * (x * x + y * y);
  return correct_rolling(ph, -speed, own + noise, 0, kNotByTheVertical);
}

ErrorStateFilter::Innovation ErrorStateFilter::correct_acceleration(int axis, double excess, double variance,
                                                                    double turned) noexcept {
  // One row of the rotation's transpose, as it was before the turn about the base's z axis.
  const double c = std::cos(turned);
  const double s = std::sin(turned);
  const Vector3d before[3] = {c * rotation.col(0) - s * rotation.col(1), s * rotation.col(0) + c * rotation.col(1),
                              rotation.col(2)};
  const Vector2d by = acceleration_by_tilt(before[axis]);
  const int a = kAccelerometerBias + axis;
  const Column ph =
      by.x() * covariance.col(kOrientation) + by.y() * covariance.col(kOrientation + 1) - covariance.col(a);
  const double own = by.x() * ph[kOrientation] + by.y() * ph[kOrientation + 1] - ph[a];
  if (!(excess * excess <= kGate * (own + variance))) return {excess * excess / (own + variance), false};
  return correct(ph, excess, own + variance, kNotByAWindow);
}

ErrorStateFilter::Innovation ErrorStateFilter::correct_gyro_at_rest(int axis, double mean, double variance,
                                                                    Rest rest) noexcept {
  const Column ph = covariance.col(kGyroBias + axis);
  return learn(ph, mean - gyro_bias[axis], ph[kGyroBias + axis] + variance,
               rest == Rest::kBegins ? std::span<const int>() : kNotAtRest);
}

ErrorStateFilter::Innovation ErrorStateFilter::correct_accelerometer_at_rest(int axis, double mean,
                                                                             double variance) noexcept {
  const Vector3d up = rotation.transpose() * Vector3d{0, 0, kGravity};
  const Vector2d by = acceleration_by_tilt(rotation.col(axis));
  const int own = kAccelerometerBias + axis;
  const Column ph =
      covariance.col(own) - by.x() * covariance.col(kOrientation) - by.y() * covariance.col(kOrientation + 1);
  const double expected = ph[own] - by.x() * ph[kOrientation] - by.y() * ph[kOrientation + 1];
  return learn(ph, mean - up[axis] - accelerometer_bias[axis], expected + variance, kNotAtRest);
}

void ErrorStateFilter::stand(double deviation) noexcept {
  velocity.setZero();
  rate.setZero();
  smooth_rate = slow_rate = 0;
  force.setZero();
  covariance.middleCols<3>(kVelocity).setZero();
  covariance.middleRows<3>(kVelocity).setZero();
  for (const int i : {0, 1, 2}) covariance(kVelocity + i, kVelocity + i) = square(deviation);
}

void ErrorStateFilter::rock(const Vector3d& turning, double deviation) noexcept {
  const Vector3d lever{geometry_.middle_x, geometry_.middle_y, geometry_.height};
  rate = turning;
  velocity = -turning.cross(lever);
  for (const int i : {0, 1, 2}) covariance(kVelocity + i, kVelocity + i) += square(deviation) * lever.squaredNorm();
}

void ErrorStateFilter::halt(double deviation) noexcept {
  for (const int i : {0, 1, 2}) {
    const Column ph = covariance.col(kVelocity + i);
    correct(ph, -velocity[i], ph[kVelocity + i] + square(deviation), {});
  }
  stand(deviation);
}

Vector3d ErrorStateFilter::acceleration_by(const Column& error) const noexcept {
  const Vector3d gravity{0, 0, -kGravity};
  const Vector3d tilt = error.segment<3>(kOrientation);
  return rotation.transpose() * gravity.cross(tilt) - error.segment<3>(kAccelerometerBias);
}

Vector3d ErrorStateFilter::acceleration_deviation() const noexcept {
  const Covariance& p = covariance;
  constexpr int t = kOrientation;
  Vector3d deviation;
  for (const int i : {0, 1, 2}) {
    const Vector2d by = acceleration_by_tilt(rotation.col(i));
    const int a = kAccelerometerBias + i;
    const double own = p(a, a) + by.x() * by.x() * p(t, t) + by.y() * by.y() * p(t + 1, t + 1);
    const double shared = by.x() * by.y() * p(t, t + 1) - by.x() * p(a, t) - by.y() * p(a, t + 1);
    deviation[i] = std::sqrt(std::max(0.0, own + 2 * shared));
  }
  return deviation;
}

}  // namespace robot_control
