#pragma once
/// Gives a description without a laser scanner the link of one, for a simulated laser.
///
/// The link kLaserLink is fixed to the root link, level, above the root's origin. It is kAboveBody above the highest
/// shape of the root body. With all joints at zero, it is at most kHighest above the lowest shape of the robot: much
/// furniture of the scenes ends at 0.8 m.

#include "machine/description/robot_description.h"

namespace robot_control {

inline constexpr const char* kLaserLink = "laser_link";
inline constexpr double kAboveBody = 0.05;  ///< m
inline constexpr double kHighest = 0.6;     ///< m

/// Returns the description as it is if it has this link or is not `wanted`. Throws RobotError as read_rigid_bodies.
RobotDescription with_laser(RobotDescription description, bool wanted);

}  // namespace robot_control
