#pragma once
/// These functions check whether a placed robot stands, and on which parts.

#include <string>
#include <vector>

#include "drivers/mujoco/contact/wheel_contacts.h"
#include "drivers/mujoco/model/mujoco_model.h"

namespace robot_control {

/// Returns whether every component of the base's velocity is below `base_speed` (m/s and rad/s) and every joint's below
/// `joint_speed`.
bool at_rest(const MujocoModel& model, const mjData& data, double base_speed, double joint_speed) noexcept;

/// Returns the joints that are not driven and faster than `joint_speed`.
std::vector<std::string> moving_joints(const MujocoModel& model, const mjData& data, double joint_speed);

/// Returns "left" or "right" if the drive wheels of that side carry less than a thousandth of the robot's weight, else
/// "".
std::string unloaded_side(const MujocoModel& model, const WheelContacts& wheels);

/// Returns the joints of drive wheels that carry less than 1 % of an equal share of the weight: "left, right"; "" if
/// there are none.
std::string unloaded_wheels(const MujocoModel& model, const WheelContacts& wheels);

/// Returns the robot's links, except its drive wheels, that touch something: "base_link, bumper".
std::string links_on_ground(const MujocoModel& model, const mjData& data);

/// Returns whether the robot is tilted by more than 30° against the ground at the site `start`.
bool fallen(const MujocoModel& model, const mjData& data) noexcept;

}  // namespace robot_control
