#pragma once
/// The controller of a robot on legs subscribes to body_pose and foot_target, and has the service set_posture. It
/// publishes leg_state. Requests for a walk on cmd_vel are refused by a line of the log.
///
/// set_posture is answered when the posture begins to change, or with the reason why it does not. Its request is no
/// sender's: nothing of it is left when the permission to move ends.

#include <memory>

#include "ros/nodes/node.h"

namespace robot_control {

std::unique_ptr<Node> make_leg_controller(const Setup& setup);

}  // namespace robot_control
