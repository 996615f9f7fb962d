#pragma once
/// Refuses robots that stand on joints which nothing holds: legs, folding arms, lifts below the body. Only wheels are
/// driven here, so gravity would fold them. These joints look similar and are accepted:
///
///   swivel       it turns about an upright axis (kUpright) and lifts nothing
///   held         its brake (JointRole::kHeld) bears an equal share of the robot's weight at its lever, or its dry
///                friction all of it
///   balanced     a rocker, a bogie or a pivoting axle has supports on both sides of its axis; for the joint above, it
///                stands on its axis
///   suspension   an upright slide with a spring (suspension.h) travels by at most the drive wheels' diameter
///   short        all other joints between the body and the support lift it by at most half of the drive wheels' radius
///
/// Supports are the drive wheels, casters and feet on the floor, at the zero pose. A robot is accepted if its centre of
/// gravity lies above the area between the supports that do not give way.

#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Throws RobotError with the joints, the depth by which the body would sink, and the remedy.
void refuse_unheld_joints(const DriveTrain& robot);

}  // namespace robot_control
