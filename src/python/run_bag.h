#pragma once
/// robot_control's logs in Python: run.bag as arrays, one that a ClosedLoop writes, and one from a black box.

#include <pybind11/pybind11.h>

namespace robot_control {

/// `read_run_bag`, `read_run_header`, `write_run_csv`, `save_black_box`; `log_into` and `end_log` of ClosedLoop.
void bind_run_bag(pybind11::module_& module);

}  // namespace robot_control
