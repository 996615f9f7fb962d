#pragma once
/// Whether a robot that was set down stands.

#include "drivers/mujoco_model.h"

namespace robot_control {

/// Every component of the base's velocity below `base_speed` (m/s and rad/s), every joint's below `joint_speed`.
bool at_rest(const MujocoModel& model, const mjData& data, double base_speed, double joint_speed) noexcept;

/// Tilted by more than 30° against the ground at the site `start`.
bool fallen(const MujocoModel& model, const mjData& data) noexcept;

}  // namespace robot_control
