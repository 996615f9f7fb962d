#pragma once
/// The filter's state → the frame that is published: of base_link, in its axes, with covariances.
///
///   base      p − R r, r the IMU's place            δ = δp + [R r]× θ
///   twist     v = u − ω × r, ω                      δv = δu + (δbg + noise) × r,  δω = −δbg − noise
/// `planar`: x, y, yaw, and forward, sideways, yaw rate; the rest is zero, with kPlanarVariance on the diagonal.

#include <Eigen/Core>

#include "estimation/filter/error_state_filter.h"
#include "signals/state_frame.h"

namespace robot_control {

inline constexpr double kPlanarVariance = 1.0e-4;  ///< m², rad²: 1 cm, 0.6°, an even floor

/// pose_odom, attitude, and their covariances.
void write_pose(const ErrorStateFilter& filter, bool planar, StateFrame& out) noexcept;

/// How well the angular velocity is known.
struct RateNoise {
  double variance = 0;  ///< (rad/s)², of each axis, beside the gyro's bias; of the filter's rate
  double tracked = 0;   ///< the same of the rate that is published, no larger
  bool gyro = true;     ///< false: it is not the gyro's, its bias does not count
};

/// `rate` rad/s, base axes: ω as it is published (rate_tracker.h). The lever ω × r keeps the filter's own, which does
/// not lag: for an IMU far from the base a lag would be a speed.
void write_twist(const ErrorStateFilter& filter, const Eigen::Vector3d& rate, const RateNoise& noise, bool planar,
                 StateFrame& out) noexcept;

/// Biases in the IMU's axes, and calibration, with their deviations.
void write_learned(const ErrorStateFilter& filter, const Eigen::Matrix3d& base_from_imu, StateFrame& out) noexcept;

}  // namespace robot_control
