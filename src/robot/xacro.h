#pragma once
/// A .xacro file as the URDF it stands for.
///
/// xacro (PyPI `xacro`, https://github.com/ros/xacro) runs in a Python process of its own, through
/// robot_control/expand_xacro.py, which lets rospkg answer `$(find PACKAGE)`: PyPI's xacro asks ROS 2's index. Its
/// default arguments hold; another choice is made by expanding the file by hand.
///
/// Python is ROBOT_CONTROL_XACRO_PYTHON, else the one of the environment that scripts/setup made, else
/// /usr/bin/python3.

#include <string>

namespace robot_control {

inline constexpr int kXacroSeconds = 30;  ///< after which it is ended

/// Throws RobotError: xacro is absent, refuses the file (in its own words), or takes longer than kXacroSeconds.
std::string expand_xacro(const std::string& path);

}  // namespace robot_control
