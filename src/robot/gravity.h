#pragma once
/// What is derived from a robot's weight is derived with this; a simulated world has the gravity of its scene.

namespace robot_control {

inline constexpr double kGravity = 9.81;  ///< m/s²

}  // namespace robot_control
