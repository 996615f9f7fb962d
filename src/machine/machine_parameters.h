#pragma once

#include <optional>
#include <string>

#include "parameters/block.h"
#include "signals/geometry.h"

namespace robot_control {

/// Holds the user's values for any machine beside its URDF. Estimator and controller use them; a simulated plant
/// follows the URDF. A note reports a difference of more than 1 % between both.
struct MachineParameters {
  std::optional<double> mass;                ///< kg
  std::optional<Vector3> centre_of_gravity;  ///< m, base axes
  std::string imu_link;                      ///< empty: found by its name, else the IMU is in the base
  std::optional<Vector3> imu_position;       ///< m, base axes
  std::optional<Vector3> imu_orientation;  ///< rad, roll, pitch and yaw of the IMU's axes in the base's, as URDF's rpy
};

inline Keys keys(MachineParameters& machine) {
  return {
      {"mass", &machine.mass, "kg", 0.01, 100000, kOptional},
      {"centre_of_gravity", &machine.centre_of_gravity, "m", -10, 10, kOptional},
      {"imu_link", &machine.imu_link, {}, 0, 0, kMayBeEmpty},
      {"imu_position", &machine.imu_position, "m", -10, 10, kOptional},
      {"imu_orientation", &machine.imu_orientation, "rad", -6.3, 6.3, kOptional},  // one full turn in each direction
  };
}

}  // namespace robot_control
