#pragma once
/// Configurations of the diff_drive_controller of ros_controllers (ROS 1) and ros2_controllers (ROS 2), which are no
/// configurations of this package, and their keys.

#include <yaml-cpp/node/node.h>

#include <string>
#include <string_view>

namespace robot_control {

/// The remedy: where keys there and keys here stand side by side.
inline constexpr const char* kPeerTable =
    "the table \"Parameters of diff_drive_controller\" in docs/interfaces.md says what each key is here";

/// By what a document is known as one ("husky_velocity_controller has type diff_drive_controller/DiffDriveController"):
/// a `ros__parameters`, a `type` that names a controller, or keys of that controller below a block that is none of
/// ours. Empty: it is none.
std::string peer_configuration(const YAML::Node& root);

/// What the key `name` of that controller, "wheel_radius_multiplier" or "linear.x.max_velocity", is here, with
/// kPeerTable; empty: it has no such key.
std::string suggest_for_peer_key(std::string_view name);

}  // namespace robot_control
