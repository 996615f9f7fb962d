#pragma once
/// Joints that bear the robot and that nothing holds: legs, folding arms, lifts below the body. Only wheels are driven
/// here, so gravity would fold them. What looks alike and stands:
///
///   swivel       turns about an upright axis (kUpright): it lifts nothing
///   held         braked (JointRole::kHeld), or its dry friction exceeds the robot's weight times its lever
///   balanced     a rocker, a bogie, a pivoting axle: what it stands on lies on both sides of its axis. To the joint
///                above it stands on its axis
///   suspension   upright slide with a spring (suspension.h), whose travel is at most the drive wheels' diameter
///   short        the travels of all other joints between the body and the support lift that by at most half of the
///                drive wheels' radius
///
/// Supports are the drive wheels, casters and feet on the floor, at the zero pose. A robot that stands without those
/// that give way, its centre of gravity above the area between the others, is accepted.

#include "robot/robot_model.h"

namespace robot_control {

/// Throws RobotError: it names the joints, how far the body would sink, and the remedy.
void refuse_unheld_joints(const RobotModel& robot);

}  // namespace robot_control
