#include "bindings/columns.h"

#include <algorithm>

#include "parameters/suggestion.h"

namespace py = pybind11;

namespace robot_control {
namespace {

/// Returns the column whose name differs least from `name`.
const TraceColumn& nearest(const std::vector<TraceColumn>& columns, const std::string& name) {
  return *std::ranges::min_element(columns, {},
                                   [&](const TraceColumn& column) { return edit_distance(column.name, name); });
}

}  // namespace

std::vector<TraceColumn> columns_of(const Robot& robot) {
  const MachineModel& machine = robot.machine();
  std::vector<std::string> names;
  for (const JointModel& joint : machine.joints) names.push_back(joint.name);
  return log_columns(names, machine.contacts, false);
}

Columns chosen_columns(const Robot& robot, const std::optional<std::vector<std::string>>& names) {
  std::vector<TraceColumn> all = columns_of(robot);
  if (!names) return {std::move(all)};
  Columns columns;
  for (const std::string& name : *names) {
    const auto found = std::ranges::find(all, name, &TraceColumn::name);
    if (found == all.end()) {
      throw py::value_error("there is no column \"" + name + "\"; did you mean \"" + nearest(all, name).name +
                            "\"? The property units of a loop names all");
    }
    columns.chosen.push_back(*found);
  }
  return columns;
}

void bind_columns(py::module_& module) {
  py::class_<Columns>(module, "Columns").def("__len__", [](const Columns& columns) { return columns.chosen.size(); });
}

}  // namespace robot_control
