#pragma once
/// A DrivenRobot is the robot as navigation sees it: its outline and its limits, by its kind.
///
/// On wheels the outline is that of all shapes with every joint at zero. On legs it encloses the walking robot, with
/// the gaits between which its speed chooses. Each foot is on the ground or lifted. It goes from its nominal place
/// (nominal_stance.h) as far as the body moves in half of a stance (foothold.h). The body moves at one of the limits,
/// in both directions, and ahead at navigate.speed.
///
/// The limits are those of the controller, within those of follow_path. Both accelerations of an axis are the smaller
/// one of acceleration and deceleration.

#include <string_view>

#include "configuration/parameters.h"
#include "machine/description/robot_description.h"
#include "navigation/footprint.h"
#include "navigation/goals/local_controller.h"

namespace robot_control::navigation {

inline constexpr double kMaxLateral = 0.3;  ///< m/s, on legs; as teleop.py

struct DrivenRobot {
  Footprint outline;
  DriveLimits limits;
  DriveControllerParameters wheels;  ///< of the controller on wheels, in force
};

/// Throws RobotError as read_rigid_bodies, on legs as read_legs, and what footprint_of throws.
DrivenRobot driven_robot(const RobotDescription& description, const Parameters& parameters);

/// Takes over a parameter of the controller on wheels that was set while it runs. Other names, and values that their
/// key does not allow, have no effect.
void set_in_force(DrivenRobot& robot, std::string_view name, double value);

}  // namespace robot_control::navigation
