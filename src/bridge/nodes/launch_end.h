#pragma once
/// The normal end of a simulated run ends its launch, too.
///
/// A node that roslaunch requires ends the launch with "REQUIRED process has died", whatever its exit code. A plant
/// whose run has come to its last cycle therefore ends the launch as Ctrl-C does, and is ended by it; a plant that dies
/// is still reported as such. Only where the launch file sets kEndsLaunch on the node, and only a roslaunch.

#include <string>

namespace robot_control {

/// Environment variable that a launch file sets on the node whose end ends the launch.
inline constexpr const char* kEndsLaunch = "ROBOT_CONTROL_ENDS_LAUNCH";

/// Is this the command line of roslaunch, as /proc/PID/cmdline has it (arguments end with NUL)?
bool is_roslaunch(const std::string& command_line);

/// SIGINT to the roslaunch that started this process. False: there is none, or kEndsLaunch is not set.
bool end_launch();

}  // namespace robot_control
