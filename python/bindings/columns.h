#pragma once
/// The columns of a loop's log that a Python program asks for: robot_control._robot_control.Columns.

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

#include "log/fields/trace_fields.h"
#include "simulation/closed_loop.h"

namespace robot_control {

/// The columns that a call returns, in this order. They are found by their names once and then used for many calls.
struct Columns {
  std::vector<TraceColumn> chosen;
};

/// Returns all columns of a robot's log.
std::vector<TraceColumn> columns_of(const Robot& robot);

/// Returns the columns with these names; all without a list. Throws value_error for an unknown name.
Columns chosen_columns(const Robot& robot, const std::optional<std::vector<std::string>>& names);

void bind_columns(pybind11::module_& module);

}  // namespace robot_control
