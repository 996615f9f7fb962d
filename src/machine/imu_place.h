#pragma once
/// Finds the place of the IMU.

#include <string>
#include <vector>

#include "machine/bodies/rigid_bodies.h"
#include "machine/machine_model.h"

namespace robot_control {

/// Returns the link of the IMU; empty: the IMU is in the base. It is `requested_link` if that is not empty, else
/// "imu_link". Else it is the first link in the file with a word that begins with "imu" or "gyro". A link that moves
/// against the root is not used. Throws RobotError if the requested link does not exist or moves.
std::string imu_link_of(const RigidBodies& robot, const std::string& requested_link, std::vector<RobotNote>& notes);

/// Returns the pose of the IMU in the base's axes: at `link` (empty: in the base), unless imu_position and
/// imu_orientation say otherwise. A difference of more than 1 % of `length` (m), or 0.01 rad, is noted. Throws
/// RobotError if a number is not finite.
Pose imu_pose(const RigidBodies& robot, const std::string& link, const MachineParameters& parameters, double length,
              std::vector<RobotNote>& notes);

}  // namespace robot_control
