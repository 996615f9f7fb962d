#pragma once
/// The node slam builds a map while the robot drives. Topics and services: docs/interfaces.md.
///
///   ~map    YAML file of a saved map, with which it begins, its robot at the map's origin or at `initialpose`;
///           "": the map begins empty, and its origin is where the robot is

namespace robot_control::navigation {

/// Makes the node and spins until ROS ends; throws what refuses the start.
void spin_slam();

}  // namespace robot_control::navigation
