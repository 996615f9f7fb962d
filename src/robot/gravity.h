#pragma once
/// The gravity of every law: of the estimator, and of what is derived from a weight. A simulated world has the gravity
/// of its scene, the same unless that says otherwise.

namespace robot_control {

inline constexpr double kGravity = 9.81;  ///< m/s²

}  // namespace robot_control
