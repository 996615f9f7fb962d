#pragma once
/// These functions check and normalise the pose of a request to set_odometry.

#include <string>

#include "signals/geometry.h"

namespace robot_control {

/// m. Beyond it the double arithmetic of odometry loses micrometres. Map coordinates (UTM) belong to the frame map (REP
/// 105), not to odom.
inline constexpr double kMaxPosition = 1.0e6;

/// rad. A yaw in degrees passes, a number beyond this is no angle.
inline constexpr double kMaxYaw = 1.0e6;

/// Returns the problems of the pose (x [m], y [m], yaw [rad]) with value, rule and remedy; "" if there are none.
std::string odometry_problem(const Vector3& pose);

/// Returns "the pose is 1 m, 2 m, 0.5 rad from the next cycle on".
std::string taken_sentence(const Vector3& pose);

/// Returns the same pose with its yaw in (−π, π].
Vector3 normalised(const Vector3& pose);

}  // namespace robot_control
