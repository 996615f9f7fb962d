#pragma once
/// Expands a .xacro file to the URDF that it describes.
///
/// xacro (PyPI `xacro`, https://github.com/ros/xacro) runs in a Python process of its own, through
/// robot_control/setup/expand_xacro.py. That module resolves `$(find PACKAGE)` with rospkg, because PyPI's xacro uses
/// ROS 2's index. The default arguments apply; for other arguments the user expands the file by hand.
///
/// The environment variable ROBOT_CONTROL_XACRO_PYTHON names the Python interpreter. Without it, that of build/xacro,
/// which scripts/setup creates, or else /usr/bin/python3 is used.

#include <string>

namespace robot_control {

inline constexpr int kXacroSeconds = 30;  ///< silence after which the process is killed

/// Throws RobotError if xacro is absent, refuses the file (in its own words), or is silent for longer than
/// kXacroSeconds.
std::string expand_xacro(const std::string& path);

}  // namespace robot_control
