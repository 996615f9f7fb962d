#pragma once
/// The steps of reading a machine. read_machine is composed of them, and so is the reading of each robot kind.

#include "machine/bodies/rigid_bodies.h"
#include "machine/machine_model.h"

namespace robot_control {

/// Returns a machine with name, source, text, base link and the notes of its bodies.
MachineModel named_machine(const RobotDescription& description, const RigidBodies& bodies);

/// Throws RobotError for more moving joints than a frame holds.
void refuse_too_many_joints(const RigidBodies& bodies);

/// Returns kPassive for a joint without an effort limit and for one that follows another joint, else kHeld.
JointRole role_of(const BodyJoint& joint);

/// Returns the joint that moves `body`, with the values of the URDF. It rests where its range is nearest to zero. One
/// that follows another joint rests where that joint puts it, and has no end stops of its own.
JointModel joint_model(const RigidBodies& bodies, const RigidBody& body, JointRole role);

/// Notes the joints that do not rest at zero.
void note_resting_places(MachineModel& machine);

struct MassSum {
  double mass = 0;                                   ///< kg
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, base axes
  double yaw_inertia = 0;                            ///< kg·m² about the vertical through the centre
};
MassSum sum_of_masses(const RigidBodies& bodies);

/// Sets mass and centre of gravity. A given centre is noted if it differs by more than 1 % of `length` (m).
void read_masses(const RigidBodies& bodies, const MachineParameters& parameters, double length, MachineModel& machine);

/// Sets link and pose of the IMU. Without a name that is "imu_link", or the first link in the file with a word that
/// begins with "imu" or "gyro". Throws RobotError if a given link does not exist or moves, or a number is not finite.
void read_imu(const RigidBodies& bodies, const MachineParameters& parameters, double length, MachineModel& machine);

/// Returns the notes with those of equal words in one, which names all their elements.
std::vector<RobotNote> merged(const std::vector<RobotNote>& notes);

}  // namespace robot_control
