#pragma once
/// Springs of drive wheels on upright sliding joints, which a URDF has no word for.
///
/// With m the part of the robot above the joint that this wheel carries (all that is above such joints, shared equally
/// among all that roll) and ω = 2π · kSuspensionFrequency:
///   load at zero m g, pushing the wheel down · stiffness m ω² · damping at least 2 m ω (critical)
/// along the joint's coordinate: force = load − stiffness · q − damping · q̇.

#include <vector>

#include "robot/wheels/drive_wheels.h"

namespace robot_control {

inline constexpr double kSuspensionFrequency = 5;  ///< Hz

/// Sets the springs of `robot` and notes them.
void assume_springs(RigidBodies& robot, const DriveTrain& train, std::vector<RobotNote>& notes);

/// Whether the joint of bodies[`body`] slides up and down.
bool is_suspension(const RigidBodies& robot, std::size_t body);

}  // namespace robot_control
