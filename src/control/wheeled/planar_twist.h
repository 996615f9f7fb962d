#pragma once
/// These types hold plain values of a differential drive: a planar twist, a value per side and a value per wheel.

#include <array>

#include "signals/wheeled/wheel_count.h"

namespace robot_control {

struct PlanarTwist {
  double linear = 0;   ///< m/s, along x of base
  double angular = 0;  ///< rad/s, about z of base
};

struct SidePair {
  double left = 0;
  double right = 0;
};

/// Holds values in the order of DriveTrain::wheels, which is that of the joints; 0 beyond the last wheel.
using WheelValues = std::array<double, kMaxWheels>;

}  // namespace robot_control
