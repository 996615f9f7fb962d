#pragma once
/// The node slam builds a map while the robot drives. Topics and services: docs/interfaces.md.
///
///   ~map    YAML file of a saved map, with which it begins, its robot at the map's origin or at `initialpose`;
///           "": the map begins empty, and its origin is where the robot is

namespace robot_control {

/// The body of main. Returns 0 after an end by a signal, 1 after a refusal, which is reported on stderr.
int run_slam(int argc, char** argv);

}  // namespace robot_control
