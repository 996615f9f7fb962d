#pragma once
/// Where the IMU sits.

#include <string>
#include <vector>

#include "robot/bodies/rigid_bodies.h"
#include "robot/robot_model.h"

namespace robot_control {

/// The link of the IMU: `requested_link` where it is not empty, else "imu_link", else the first link in the file with a
/// word of its name that begins with "imu" or "gyro", each only if it does not move against the root. Empty: in the
/// base. Throws RobotError: a requested link that does not exist or moves.
std::string imu_link_of(const RigidBodies& robot, const std::string& requested_link, std::vector<RobotNote>& notes);

/// Where the IMU sits, in the base's axes: at `link` (empty: in the base), but for what imu_position and
/// imu_orientation say otherwise. A difference of more than 1 % of `wheel_base`, or 0.01 rad, is noted. Throws
/// RobotError: a number that is not finite.
Pose imu_pose(const RigidBodies& robot, const std::string& link, const RobotParameters& parameters, double wheel_base,
              std::vector<RobotNote>& notes);

}  // namespace robot_control
