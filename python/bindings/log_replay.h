#pragma once
/// This binds the replay of a log to Python: robot_control._robot_control.replay_log, for replay.py.

#include <pybind11/pybind11.h>

namespace robot_control {

void bind_log_replay(pybind11::module_& module);

}  // namespace robot_control
