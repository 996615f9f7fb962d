#pragma once
/// These functions recognise configurations of the diff_drive_controller of ros_controllers (ROS 1) and
/// ros2_controllers (ROS 2). They are no configurations of this package.

#include <yaml-cpp/node/node.h>

#include <optional>
#include <string>
#include <string_view>

#include "parameters/problem_list.h"

namespace robot_control {

/// The remedy: a table with the keys of both packages.
inline constexpr const char* kPeerTable =
    "the table \"Parameters of diff_drive_controller\" in docs/interfaces.md says what each key is here";

/// Returns a problem if the document of the file `path` is such a configuration, with the evidence:
/// "husky_velocity_controller with type diff_drive_controller/DiffDriveController". Evidence is a `ros__parameters`, a
/// `type` that names a controller, or keys of that controller below a block that this package does not have.
std::optional<Problem> peer_problem(const std::string& path, const YAML::Node& root);

/// Returns this package's key for the key `name` of that controller ("wheel_radius_multiplier",
/// "linear.x.max_velocity"), with kPeerTable. Returns "" if that controller has no such key.
std::string suggest_for_peer_key(std::string_view name);

}  // namespace robot_control
