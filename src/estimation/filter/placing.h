#pragma once
/// Sets the filter down: at a given pose, or where an earlier process left it.

#include <Eigen/Core>

#include "estimation/filter/error_state_filter.h"
#include "signals/state_frame.h"

namespace robot_control {

inline constexpr double kUnknownSpeed = 2.0;  ///< m/s, standard deviation of a velocity that is not measured yet

/// base_link at x [m], y [m], yaw [rad]; height and tilt stay. The covariance of what is set is zero.
void place(const Vector3& pose, ErrorStateFilter& filter) noexcept;

/// Finite, and the state was valid.
bool continuable(const StateFrame& last) noexcept;

/// Pose, height, biases and calibration of a frame that is continuable, with their covariance; the velocity for what it
/// is worth by now: kUnknownSpeed.
void continue_from(const StateFrame& last, const Eigen::Matrix3d& base_from_imu, ErrorStateFilter& filter) noexcept;

}  // namespace robot_control
