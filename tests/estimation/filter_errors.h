#pragma once
/// What tests of the error-state filter share: the error between two nominal states, in the filter's own order.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "estimation/filter/error_state_filter.h"

namespace robot_control {

/// Log of a rotation below a half turn.
inline Eigen::Vector3d angle_of(const Eigen::Matrix3d& rotation) {
  const Eigen::Vector3d twice_sine{rotation(2, 1) - rotation(1, 2), rotation(0, 2) - rotation(2, 0),
                                   rotation(1, 0) - rotation(0, 1)};
  const double sine = twice_sine.norm() / 2;
  const double angle = std::atan2(sine, (rotation.trace() - 1) / 2);
  return sine < 1e-12 ? Eigen::Vector3d(twice_sine / 2) : Eigen::Vector3d(twice_sine / (2 * sine) * angle);
}

/// The error that `inject` would have to add to `from` to make it `to`.
inline ErrorStateFilter::Column error_between(const ErrorStateFilter& from, const ErrorStateFilter& to) {
  using Filter = ErrorStateFilter;
  Filter::Column error;
  error.segment<3>(Filter::kPosition) = to.position - from.position;
  error.segment<3>(Filter::kOrientation) = angle_of(to.rotation * from.rotation.transpose());
  error.segment<3>(Filter::kVelocity) = to.velocity - from.velocity;
  error.segment<2>(Filter::kTravel) = to.travel - from.travel;
  error.segment<3>(Filter::kGyroBias) = to.gyro_bias - from.gyro_bias;
  error.segment<3>(Filter::kAccelerometerBias) = to.accelerometer_bias - from.accelerometer_bias;
  error[Filter::kRadiusRatio] = to.radius_ratio - from.radius_ratio;
  error[Filter::kWheelBase] = to.wheel_base - from.wheel_base;
  error[Filter::kGyroScale] = to.gyro_scale - from.gyro_scale;
  return error;
}

}  // namespace robot_control
