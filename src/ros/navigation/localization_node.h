#pragma once
/// The node localization finds the robot in a saved map. Topics and services: docs/interfaces.md.
///
///   ~map            YAML file of the map; "": it waits for load_map
///   ~initial_pose   [x, y, yaw] in m and rad, where the robot is at the start; left out: it waits for initialpose or
///                   global_localization

namespace robot_control::navigation {

/// Makes the node and spins until ROS ends; throws what refuses the start.
void spin_localization();

}  // namespace robot_control::navigation
