#pragma once
/// This type holds the motion by gyro and accelerometer at one time; it can be interpolated.

#include "estimation/values.h"

namespace robot_control {

struct InertialMotion {
  double time = 0;      ///< s
  Planar path{};        ///< m, odom axes: ∬ acceleration dt² of the IMU since the restart
  Planar lever{};       ///< m, odom axes: from the middle of the wheels to the IMU
  Planar velocity{};    ///< m/s, odom axes: integral of the acceleration since the restart
  double yaw = 0;       ///< rad
  double yaw_rate = 0;  ///< rad/s
};

/// Interpolates between two motions; `from` is not the later one. Path and yaw follow the cubic through values and
/// derivatives of both (Hermite), the rest a line. Outside of both, the nearer one is carried on at its velocities.
InertialMotion interpolated(const InertialMotion& from, const InertialMotion& to, double time) noexcept;

}  // namespace robot_control
