#pragma once
/// This binds robot_control's logs to Python: reading run.bag as arrays, logging a ClosedLoop, saving a black box.

#include <pybind11/pybind11.h>

namespace robot_control {

/// Adds `read_run_bag`, `read_run_header`, `each_part_of_run_bag`, `save_black_box`, and `log_into` and `end_log` of
/// ClosedLoop.
void bind_run_bag(pybind11::module_& module);

}  // namespace robot_control
