#pragma once
/// Numbers that several tests of the simulated machine share.

namespace robot_control {

inline constexpr double kEarthGravity = 9.81;  ///< m/s²
inline constexpr double kStep = 0.001;         ///< s

}  // namespace robot_control
