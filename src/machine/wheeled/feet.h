#pragma once
/// Corrects the supports of a robot beside its drive wheels, because drawings are not exact.
///
/// The floor is the mean height of the drive wheels' lowest points at the zero pose, z upwards in the root's axes.
///
///   feet        a sliding shape or a rolling caster whose lowest point is within kHeightTolerance of the floor is moved to the
///               floor, because rigid feet that are 0.05 mm lower would lift the wheels
///   footprints  a thin shape on the floor that marks the place of the robot is left out. It is on the root link or on
///               a link named "footprint" (REP 120), and that link's origin is within kFloorTolerance of the floor and
///               above or below the shape. The shape begins at most kHeightTolerance above the floor, and its height and its
///               upper end are at most kThin
///
/// Both are noted, except for less than 1 µm.

#include <vector>

#include "machine/wheeled/wheels/drive_wheels.h"

namespace robot_control {

inline constexpr double kHeightTolerance = 0.001;  ///< m
inline constexpr double kThin = 0.02;              ///< m

/// Returns the height of the floor in the root's axes, m.
double floor_height(const RunningGear& gear);

/// Corrects feet and footprints as above.
void set_feet(RigidBodies& robot, RunningGear& gear, std::vector<RobotNote>& notes);

}  // namespace robot_control
