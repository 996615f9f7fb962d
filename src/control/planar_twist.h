#pragma once
/// The two numbers that a differential drive can follow, and a value per wheel.

namespace robot_control {

struct PlanarTwist {
  double linear = 0;   ///< m/s, along x of base
  double angular = 0;  ///< rad/s, about z of base
};

struct WheelPair {
  double left = 0;
  double right = 0;
};

}  // namespace robot_control
