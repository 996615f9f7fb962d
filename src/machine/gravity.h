#pragma once
/// This gravity is used by the estimator and for all that is derived from a weight. A simulated world has the gravity
/// of its scene, which is the same by default.

namespace robot_control {

inline constexpr double kGravity = 9.81;  ///< m/s²

}  // namespace robot_control
