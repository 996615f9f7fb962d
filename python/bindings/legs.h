#pragma once
/// Binds the kinematics of robots on legs: robot_control.legs.

#include <pybind11/pybind11.h>

namespace robot_control {

void bind_legs(pybind11::module_& module);

}  // namespace robot_control
