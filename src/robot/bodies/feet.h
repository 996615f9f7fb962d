#pragma once
/// What a robot stands on beside its drive wheels, where drawings are not exact.
///
/// The floor is the mean height of the drive wheels' lowest points at the zero pose, z upwards in the root's axes.
///
///   feet        A shape that slides, or a caster that rolls, whose lowest point is within kLevel of the floor is moved
///               to the floor: a robot on rigid feet has its wheels in the air when these are 0.05 mm lower.
///   footprints  A shape no higher than kThin and ending no higher than kThin above the floor, on the root link or one
///               whose name says "footprint" (REP 120), where the link's origin is within kFloorTolerance of the
///               floor and below or above the shape, and which begins no higher than kLevel above the floor: a mark
///               of where the robot is, no part of it. It is left out.
///
/// Both are noted, but for less than 1 µm.

#include <vector>

#include "robot/wheels/drive_wheels.h"

namespace robot_control {

inline constexpr double kLevel = 0.001;  ///< m
inline constexpr double kThin = 0.02;    ///< m

/// m, in the root's axes.
double floor_height(const DriveTrain& train);

/// As above.
void set_feet(RigidBodies& robot, DriveTrain& train, std::vector<RobotNote>& notes);

}  // namespace robot_control
