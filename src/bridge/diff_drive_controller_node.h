#pragma once
/// diff_drive_controller: cmd_vel, cmd_vel_stamped in; joint_commands, joint_targets, cmd_vel_out out.

#include <memory>

#include "bridge/node.h"

namespace robot_control {

std::unique_ptr<Node> make_diff_drive_controller(const Setup& setup);

}  // namespace robot_control
