#pragma once
/// The controller subscribes to cmd_vel and cmd_vel_stamped. It publishes joint_commands, joint_targets,
/// cmd_vel_out and drive_state. It has the services ~set_parameters (dynamic_reconfigure, with ~parameter_descriptions
/// and ~parameter_updates) and ~set_parameter_map.
///
/// A command's stamp is compared, at its arrival, with the clock that senders use for stamps. That is the time of day;
/// in lockstep it is the stamp of the newest sensor frame, which is the time of /clock. TimeMap is not used for this:
/// it never goes backwards, so every command would seem too old after the time of day was set back.

#include <memory>

#include "ros/nodes/node.h"

namespace robot_control {

std::unique_ptr<Node> make_controller(const Setup& setup);

}  // namespace robot_control
