#pragma once
/// robot_control._robot_control.ClosedLoop and ClosedLoops.

#include <pybind11/pybind11.h>

namespace robot_control {

void bind_closed_loop(pybind11::module_& module);
void bind_closed_loops(pybind11::module_& module);

}  // namespace robot_control
