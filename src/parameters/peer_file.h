#pragma once
/// These functions recognise configurations of the diff_drive_controller of ros_controllers (ROS 1) and
/// ros2_controllers (ROS 2). They are no configurations of this package.

#include <yaml-cpp/node/node.h>

#include <string>
#include <string_view>

namespace robot_control {

/// The remedy: a table with the keys of both packages.
inline constexpr const char* kPeerTable =
    "the table \"Parameters of diff_drive_controller\" in docs/interfaces.md says what each key is here";

/// Returns the evidence that a document is such a configuration: "husky_velocity_controller has type
/// diff_drive_controller/DiffDriveController". Evidence is a `ros__parameters`, a `type` that names a controller, or
/// keys of that controller below a block that this package does not have. Returns "" if there is none.
std::string peer_configuration(const YAML::Node& root);

/// Returns this package's key for the key `name` of that controller ("wheel_radius_multiplier",
/// "linear.x.max_velocity"), with kPeerTable. Returns "" if that controller has no such key.
std::string suggest_for_peer_key(std::string_view name);

}  // namespace robot_control
