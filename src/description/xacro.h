#pragma once
/// A .xacro file as the URDF it stands for.
///
/// xacro (PyPI `xacro`, https://github.com/ros/xacro) runs in a Python process of its own, through
/// robot_control/expand_xacro.py, which resolves `$(find PACKAGE)` with rospkg: PyPI's xacro uses ROS 2's index. Its
/// default arguments hold; another choice is made by expanding the file by hand.
///
/// Python is what the environment calls ROBOT_CONTROL_XACRO_PYTHON, else that of build/xacro, which scripts/setup
/// makes, else /usr/bin/python3.

#include <string>

namespace robot_control {

inline constexpr int kXacroSeconds = 30;  ///< after which it is ended

/// Throws RobotError: xacro is absent, refuses the file (in its own words), or is silent for longer than kXacroSeconds.
std::string expand_xacro(const std::string& path);

}  // namespace robot_control
