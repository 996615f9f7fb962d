#pragma once
/// The normal end of a simulated run also ends its launch, and so does a robot that is refused.
///
/// A node that roslaunch requires ends the launch with "REQUIRED process has died", whatever its exit code. A plant
/// whose run has reached its last cycle therefore interrupts roslaunch as Ctrl-C does, and roslaunch then ends the
/// plant. A plant that dies is still reported as dead. All nodes of a launch refuse a robot alike; the first of them
/// says why and interrupts roslaunch. This applies only if the launch file sets kEndsLaunch on the node, and only to
/// roslaunch as parent.

#include <string>

namespace robot_control {

/// A launch file sets this environment variable on the nodes whose end ends the launch.
inline constexpr const char* kEndsLaunch = "ROBOT_CONTROL_ENDS_LAUNCH";

/// Returns whether a launch file that sets kEndsLaunch has started this process.
bool launched();

/// Returns the process ids of the nodes that roslaunch runs, in words. An interrupt while it still starts nodes leaves
/// some of them behind.
std::string launched_nodes();

/// Returns true in the first of the processes with this parent that call it, while that process lives.
bool first_to_refuse();

/// Returns whether this is a command line of roslaunch in the form of /proc/PID/cmdline (arguments end with NUL).
bool is_roslaunch(const std::string& command_line);

/// Sends SIGINT to the roslaunch that started this process. Returns false if there is none, or if kEndsLaunch is not
/// set.
bool end_launch();

}  // namespace robot_control
