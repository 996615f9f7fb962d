#pragma once
/// This binds BagReader to Python.

#include <pybind11/pybind11.h>

namespace robot_control {

void bind_bag(pybind11::module_& module);

}  // namespace robot_control
