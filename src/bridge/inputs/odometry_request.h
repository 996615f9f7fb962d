#pragma once
/// set_odometry: whether a pose can be meant, and how it is taken.

#include <string>

#include "signals/geometry.h"

namespace robot_control {

/// m; beyond, double arithmetic of odometry loses micrometres, and no robot drives there: map coordinates (UTM) belong
/// into the frame map (REP 105).
inline constexpr double kMaxPosition = 1.0e6;

/// rad; a yaw in degrees passes, one beyond this is no angle.
inline constexpr double kMaxYaw = 1.0e6;

/// What is wrong with (x [m], y [m], yaw [rad]), with value, rule and remedy; empty: nothing.
std::string odometry_problem(const Vector3& pose);

/// "the pose is 1 m, 2 m, 0.5 rad from the next cycle on"
std::string taken_sentence(const Vector3& pose);

/// The same pose with its yaw in (−π, π].
Vector3 normalised(const Vector3& pose);

}  // namespace robot_control
