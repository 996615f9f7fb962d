#pragma once
/// The controller of a robot on legs subscribes to cmd_vel, cmd_vel_stamped, body_pose, foot_target and
/// joint_trajectory, and has the services set_posture and set_gait. It publishes leg_state and cmd_vel_out.
///
/// A trajectory (ros/legged/joint_trajectory.h) is executed while the robot lies. This node requests every 10 ms where
/// the joints shall be kHorizon later (control/legged/joints/joint_motion.h), as if its sender had done so. It ends
/// early with the permission to move and with the connection of its sender. An empty trajectory of any sender and a
/// message on another topic end it, too. Its sender may replace it, others may not. After it the sender counts as
/// having sent zero.
///
/// While the robot walks, a body_pose belongs to the request of the node that sends the twists (command_input.h). The
/// gait of set_gait holds until the permission to move ends.
///
/// set_posture is answered when the posture begins to change, or with the reason why it does not. Its request is no
/// sender's: nothing of it is left when the permission to move ends.

#include <memory>

#include "ros/nodes/node.h"

namespace robot_control {

std::unique_ptr<Node> make_leg_controller(const Setup& setup);

}  // namespace robot_control
