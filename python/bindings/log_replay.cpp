#include "bindings/log_replay.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bindings/layers.h"
#include "bindings/loop_replay.h"
#include "bindings/numpy_version.h"
#include "configuration/live_parameters.h"
#include "log/messages/message_types.h"
#include "log/replay/continuity.h"
#include "log/trace_reader.h"
#include "loop/log_header.h"
#include "robots/robot_kind.h"
#include "signals/roles.h"

namespace py = pybind11;

namespace robot_control {
namespace {

using namespace py::literals;

/// The path of a parameter file and the values that are laid over it.
using Layers = std::pair<std::string, LayerValues>;

/// VariedColumns holds the outputs of the laws, logged and with other parameters, by column of a log.
class VariedColumns {
 public:
  explicit VariedColumns(const MachineModel& robot) {
    for (const std::size_t joint : driven_joint_indices(robot)) {
      efforts_.emplace_back(joint, "command_effort_" + robot.joints[joint].name);
    }
  }

  void add(const VariedRow& row) {
    if (row.state != nullptr) {
      const StateFrame& was = *row.state;
      const StateFrame& would = *row.varied_state;
      add("estimate_x", was.base.pose_odom.position[0], would.base.pose_odom.position[0]);
      add("estimate_y", was.base.pose_odom.position[1], would.base.pose_odom.position[1]);
      add("estimate_linear", was.base.twist_base.linear[0], would.base.twist_base.linear[0]);
      add("estimate_angular", was.base.twist_base.angular[2], would.base.twist_base.angular[2]);
    }
    if (row.command != nullptr) {
      const CommandFrame& was = *row.command;
      const CommandFrame& would = *row.varied_command;
      add("limited_linear", was.twist_limited.linear[0], would.twist_limited.linear[0]);
      add("limited_angular", was.twist_limited.angular[2], would.twist_limited.angular[2]);
      for (const auto& [joint, name] : efforts_) add(name, was.joints[joint].effort, would.joints[joint].effort);
    }
    if (row.permit != nullptr) {
      add("supervisor_state", static_cast<double>(row.permit->state), static_cast<double>(row.varied_permit->state));
    }
  }

  /// Returns {name: (logged, varied)}, with one value per row of that law.
  py::dict arrays() const {
    py::dict result;
    for (const auto& [name, column] : columns_) {
      result[py::str(name)] =
          py::make_tuple(py::array_t<double>(py::ssize_t(column.first.size()), column.first.data()),
                         py::array_t<double>(py::ssize_t(column.second.size()), column.second.data()));
    }
    return result;
  }

 private:
  void add(const std::string& name, double was, double would) {
    auto& column = columns_[name];
    column.first.push_back(was);
    column.second.push_back(would);
  }

  std::vector<std::pair<std::size_t, std::string>> efforts_;  ///< driven joint, column
  std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> columns_;
};

/// Returns the differences of processor and C library, which can change the computed bits of equal programs.
std::vector<std::string> doubts(const LogHeader& logged, const LogHeader& here) {
  std::vector<std::string> found;
  const auto compare = [&](const char* what, const std::string& was, const std::string& is) {
    if (was != is) found.push_back(std::string("the log is of another ") + what + ": " + was + "; here: " + is);
  };
  compare("processor", logged.processor, here.processor);
  compare("C library", logged.libraries, here.libraries);
  return found;
}

/// Returns one sentence per field of the header that contradicts its own parameters and URDF, or was changed after it
/// was written.
std::vector<std::string> header_differences(const LogHeader& logged, const LogHeader& computed) {
  std::vector<std::string> found;
  if (!intact(logged)) found.emplace_back("header: one of its fields was changed: its checksum is that of others");
  const auto compare = [&](const char* field, const auto& was, const auto& is) {
    if (was != is) found.push_back(std::string("header: ") + field + " is not that of its parameters and its URDF");
  };
  compare("robot", logged.robot, computed.robot);
  if (!logged.kind.empty()) {  // earlier versions had only one kind
    compare("kind", logged.kind, computed.kind);
    compare("roles", logged.roles, computed.roles);
    compare("contacts", logged.contacts, computed.contacts);
  }
  compare("joints", logged.joints, computed.joints);
  compare("wheels", logged.wheels, computed.wheels);
  compare("period", logged.period, computed.period);
  compare("clock", logged.clock, computed.clock);
  return found;
}

/// `logged` are the parameters of the log, `varied` are other parameters or None.
py::dict replay_log(const std::string& path, const Layers& logged, const std::optional<Layers>& varied) {
  check_numpy_version();
  const Parameters parameters = read_layers(logged.first, logged.second, "replay", logged.first);
  const std::unique_ptr<Robot> composed = make_robot(parameters);
  const MachineModel& robot = composed->machine();
  Replay replay(*composed, parameters.loop.period());
  VariedColumns columns(robot);
  std::unique_ptr<Robot> varied_robot;
  std::vector<std::string> live;  // values that the log leaves out but `varied` sets are included
  if (varied) {
    const Parameters others = read_layers(varied->first, varied->second, "replay", logged.first);
    if (others.loop.rate != parameters.loop.rate) {
      std::ostringstream text;
      text << "robot.rate is " << others.loop.rate << " Hz, that of the log " << parameters.loop.rate
           << " Hz: its rows cannot be made more or fewer; leave robot.rate out";
      throw ReplayError(text.str());
    }
    varied_robot = make_robot(others);
    replay.vary(*varied_robot, [&](const VariedRow& row) { columns.add(row); });
    for (const LiveParameter& each : live_parameters(others, std::string(program_of(Role::kController))))
      live.push_back(each.key);
  }
  LogHeader header;
  std::string cut;
  {
    const py::gil_scoped_release release;
    // All snapshots are read first: telemetry may have found a node's rows before its first snapshot and written the
    // latter late.
    TraceReader reader(path, {.snapshot = [&](const LawSnapshot& snapshot, std::int64_t) { replay.add(snapshot); }});
    if (!reader.of_this_version()) {
      const LogHeader other = reader.header();
      throw ReplayError("its messages Trace have other fields than those of this version (" + package_version() +
                        "): version " + other.version + ", build " + other.build + " wrote it; replay with that build");
    }
    header = reader.header();
    cut = reader.cut();
    reader.read({.message = [&](const TraceRow& row, const BagMessage& message) {
      replay.add(row, message.data, static_cast<std::int64_t>(message.time_ns));
    }});
  }
  py::dict result = described(replay.report());
  const LogHeader here = log_header(parameters, *composed);
  result["varied"] = columns.arrays();
  result["doubts"] = doubts(header, here);
  result["header"] = header_differences(header, here);
  result["cut"] = cut;
  result["record"] = header.record;
  result["live"] = live;
  result["period"] = header.period;
  return result;
}

}  // namespace

void bind_log_replay(py::module_& module) {
  py::register_exception<ReplayError>(module, "ReplayError", PyExc_RuntimeError);
  module.def("replay_log", &replay_log, "path"_a, "logged"_a, "varied"_a);
}

}  // namespace robot_control
