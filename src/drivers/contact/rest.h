#pragma once
/// Whether a robot that was set down stands, and on what.

#include <string>

#include "drivers/contact/wheel_contacts.h"
#include "drivers/model/mujoco_model.h"

namespace robot_control {

/// Every component of the base's velocity below `base_speed` (m/s and rad/s), every joint's below `joint_speed`.
bool at_rest(const MujocoModel& model, const mjData& data, double base_speed, double joint_speed) noexcept;

/// "left" or "right": the drive wheels of that side bear less than a thousandth of the robot's weight; else empty.
std::string unloaded_side(const MujocoModel& model, const WheelContacts& wheels);

/// The drive wheels' joints that bear less than 1 % of what they would if all bore the same: "left, right"; else empty.
std::string unloaded_wheels(const MujocoModel& model, const WheelContacts& wheels);

/// The robot's links, other than its drive wheels, that touch something: "base_link, bumper".
std::string links_on_ground(const MujocoModel& model, const mjData& data);

/// Tilted by more than 30° against the ground at the site `start`.
bool fallen(const MujocoModel& model, const mjData& data) noexcept;

}  // namespace robot_control
