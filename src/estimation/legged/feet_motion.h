#pragma once
/// The feet of a robot on legs in one cycle, from its joints and its gyro. All vectors are in base axes.
///
/// A ball foot rolls. While it stands, its centre moves over the ground with r ωₛ × u. r is its radius, ωₛ the rate of
/// its shank, u points upwards.

#include <Eigen/Core>
#include <array>

#include "machine/legs/leg_model.h"
#include "signals/sensor_frame.h"

namespace robot_control {

struct FeetMotion {
  std::array<Eigen::Vector3d, kLegs> place;          ///< m, of the foot's centre
  std::array<Eigen::Matrix3d, kLegs> jacobian;       ///< m/rad
  std::array<Eigen::Vector3d, kLegs> rolling;        ///< m/s, of the foot's centre over the ground while it stands
  std::array<Eigen::Vector3d, kLegs> base_velocity;  ///< m/s, of the base's origin if this foot stands
  LegsValues angles{}, rates{};                      ///< rad, rad/s; 0 where they are not valid
};

/// `rate` is that of the base in rad/s.
FeetMotion feet_motion(const std::array<Leg, kLegs>& legs, const SensorFrame& sensors, const Eigen::Vector3d& rate,
                       const Eigen::Vector3d& up) noexcept;

}  // namespace robot_control
