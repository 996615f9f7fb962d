#pragma once
/// Assumes springs for drive wheels on upright sliding joints, because a URDF cannot state them.
///
/// Let m be the mass above the joint that this wheel carries. All mass above such joints is shared equally among all
/// rolling bodies. With ω = 2π · kSuspensionFrequency the spring has
///   load at zero m g, pushing the wheel down · stiffness m ω² · damping at least 2 m ω (critical)
/// along the joint's coordinate: force = load − stiffness · q − damping · q̇.

#include <vector>

#include "machine/wheeled/wheels/drive_wheels.h"

namespace robot_control {

/// Finds rockers: arms that each carry the wheels of one side and pitch about a lateral axis. Such machines have a
/// differential, a bar or a gear that turns one rocker down when the other goes up. It keeps the chassis at the mean of
/// both. A URDF often leaves it out, and its chassis would tip until it meets the joints' stops.
///
/// A differential is assumed if exactly two such joints hang on one body and have no <mimic>. One must be above all
/// left and one above all right drive wheels, at least two each. The right joint follows the left one with the opposite
/// sign in base axes.
///
/// Sets the follower's BodyJoint::mimicked and notes it.
void assume_differential(RigidBodies& robot, const RunningGear& gear, std::vector<RobotNote>& notes);

inline constexpr double kSuspensionFrequency = 5;  ///< Hz

/// Sets the springs of `robot` and notes them.
void assume_springs(RigidBodies& robot, const RunningGear& gear, std::vector<RobotNote>& notes);

/// Returns true if the joint of bodies[`body`] slides up and down.
bool is_suspension(const RigidBodies& robot, std::size_t body);

}  // namespace robot_control
