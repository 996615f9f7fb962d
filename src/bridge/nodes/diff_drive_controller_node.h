#pragma once
/// diff_drive_controller: cmd_vel, cmd_vel_stamped in; joint_commands, joint_targets, cmd_vel_out, drive_state out;
/// ~set_parameters (dynamic_reconfigure, with ~parameter_descriptions and ~parameter_updates) and ~set_parameter_map.
///
/// A command's stamp is compared with the clock that senders stamp with, at its arrival: the time of day, in lockstep
/// the stamp of the newest sensor frame, which is the time of /clock. (TimeMap, which never turns back, would take all
/// commands for old ones after the time of day was set back.)

#include <memory>

#include "bridge/nodes/node.h"
#include "signals/command_frame.h"

namespace robot_control {

std::unique_ptr<Node> make_diff_drive_controller(const Setup& setup);

}  // namespace robot_control
