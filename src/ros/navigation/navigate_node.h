#pragma once
/// The node navigate: actions navigate_to and move_base, topic move_base_simple/goal.

namespace robot_control::navigation {

/// Makes the node and spins until ROS ends; throws what refuses the start.
void spin_navigate();

}  // namespace robot_control::navigation
