#include "simulation/closed_loop.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings/columns.h"
#include "bindings/describe.h"
#include "bindings/layers.h"
#include "bindings/loop_bindings.h"
#include "bindings/loop_replay.h"
#include "bindings/numpy_version.h"
#include "bindings/recorder.h"
#include "control/common/limits/stop_distance.h"
#include "control/legged/walk/gait.h"
#include "control/legged/walk/own_gaits.h"
#include "control/legged/walk/twist_limiter.h"
#include "control/wheeled/limits/drive_limits.h"
#include "control/wheeled/smooth_speed.h"
#include "machine/legs/leg_model.h"
#include "machine/wheeled/drive_train.h"
#include "robots/wheeled/start_check.h"
#include "signals/robot_kinds.h"

namespace py = pybind11;

namespace robot_control {
namespace {

using namespace py::literals;

Twist planar(double linear, double lateral, double angular) {
  return {.linear = {linear, lateral, 0}, .angular = {0, 0, angular}};
}

/// Returns the numbers of a sequence of two or three; none of anything else.
std::optional<Twist> twist_of(const py::handle& given) {
  const py::object items = py::reinterpret_steal<py::object>(PySequence_Fast(given.ptr(), ""));
  if (items) {
    std::array<double, 3> numbers{};
    const py::ssize_t count = PySequence_Fast_GET_SIZE(items.ptr());
    for (py::ssize_t i = 0; i < std::min<py::ssize_t>(count, 3); ++i)
      numbers[static_cast<std::size_t>(i)] = PyFloat_AsDouble(PySequence_Fast_GET_ITEM(items.ptr(), i));
    if (PyErr_Occurred() == nullptr && count == 2) return planar(numbers[0], 0, numbers[1]);
    if (PyErr_Occurred() == nullptr && count == 3) return planar(numbers[0], numbers[1], numbers[2]);
  }
  PyErr_Clear();
  return std::nullopt;
}

Twist command_of(const py::handle& given) {
  if (const std::optional<Twist> twist = twist_of(given)) return *twist;
  throw py::type_error(
      "command must give (linear, angular), two numbers in m/s and rad/s, or (linear, lateral, "
      "angular); it gave " +
      std::string(py::repr(given)));
}

/// Runs `cycles` cycles. `command` is (linear, angular) or (linear, lateral, angular), which arrives in each cycle, a
/// function that returns such a tuple for a time, or None. Other Python threads run meanwhile if no function needs the
/// interpreter. `replay` stores the cycles, or is None.
py::dict run(ClosedLoop& loop, std::int64_t cycles, const py::object& command, const Columns& columns,
             LoopReplay* replay) {
  constexpr std::int64_t kBlock = 1000;  // cycles between two checks for Ctrl-C
  if (cycles < 0) throw py::value_error("cycles must not be negative");
  const std::vector<TraceColumn>& chosen = columns.chosen;
  std::vector<py::array_t<double>> arrays;
  std::vector<double*> cells;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    arrays.emplace_back(cycles);
    cells.push_back(arrays.back().mutable_data());
  }
  const auto step = [&](std::int64_t row) {
    loop.step();
    if (replay != nullptr) replay->store(loop);
    for (std::size_t i = 0; i < chosen.size(); ++i) cells[i][row] = chosen[i].value(loop.row(), chosen[i].element);
  };
  const bool asks = PyCallable_Check(command.ptr()) != 0;
  const bool constant = !asks && !command.is_none();
  const Twist sent = constant ? command_of(command) : Twist{};
  for (std::int64_t first = 0; first < cycles; first += kBlock) {
    const std::int64_t last = std::min(first + kBlock, cycles);
    if (asks) {
      for (std::int64_t row = first; row < last; ++row) {
        loop.command(command_of(command(loop.time())));
        step(row);
      }
    } else {
      const py::gil_scoped_release release;
      for (std::int64_t row = first; row < last; ++row) {
        if (constant) loop.command(sent);
        step(row);
      }
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  py::dict log;
  for (std::size_t i = 0; i < chosen.size(); ++i) log[py::str(chosen[i].name)] = arrays[i];
  return log;
}

py::dict scan_of(const ClosedLoop& loop) {
  const LaserScan scan = loop.scan();
  if (scan.ranges.empty()) throw py::value_error("there is no laser: set laser.rate of the simulated machine");
  return py::dict("cycle"_a = scan.head.cycle, "stamp_ns"_a = scan.head.stamp_ns, "link"_a = scan.link,
                  "angle_min"_a = scan.angle_min, "angle_increment"_a = scan.angle_increment,
                  "range_min"_a = scan.range_min, "range_max"_a = scan.range_max,
                  "ranges"_a = py::array_t<float>(static_cast<py::ssize_t>(scan.ranges.size()), scan.ranges.data()));
}

/// Returns the distance in m of a ramp from `speed`, including the cycle before it begins.
double distance_to_stop(const ClosedLoop& loop, double speed, bool emergency) {
  const Parameters& parameters = loop.parameters();
  if (loop.robot().kind() == kLeggedKind)
    return walking_stop_distance(parameters.leg_control, leg_model_of(loop.robot().machine()).leg_length(), speed,
                                 emergency);
  const MotionLimits limits = speed_limits(parameters.controller).linear;
  const double deceleration = emergency ? limits.emergency_deceleration : limits.deceleration_from(speed);
  return stop_distance(speed, deceleration, limits.jerk) + std::abs(speed) * parameters.loop.period();
}

double smooth_speed_of(const ClosedLoop& loop) {
  const Parameters& parameters = loop.parameters();
  return smooth_speed(parameters.controller, drive_train_of(loop.robot().machine()),
                      encoder_count(parameters.estimator), parameters.loop.period());
}

std::vector<std::pair<std::string, std::string>> column_meanings(const ClosedLoop& loop) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const TraceColumn& column : columns_of(loop.robot())) names.emplace_back(column.name, column.meaning);
  return names;
}

using ModeNumbers = std::array<std::uint64_t, 2>;  // kind and index

Mode mode_of(const ModeNumbers& numbers) {
  return {static_cast<ModeKind>(numbers[0]), numbers[1]};
}

}  // namespace

void bind_closed_loop(py::module_& module) {
  py::class_<ClosedLoop, std::shared_ptr<ClosedLoop>>(module, "ClosedLoop")
      .def(py::init([](const std::string& path, const LayerValues& values) {
             check_numpy_version();
             return std::make_unique<ClosedLoop>(parameters_from(path, values));
           }),
           "path"_a, "values"_a)
      .def(
          "command",
          [](ClosedLoop& loop, double linear, double angular, double lateral) {
            loop.command(planar(linear, lateral, angular));
          },
          "linear"_a, "angular"_a, "lateral"_a = 0.0)
      .def(
          "choose_mode", [](ClosedLoop& loop, const ModeNumbers& mode) { loop.choose_mode(mode_of(mode)); }, "mode"_a)
      .def(
          "request",
          [](ClosedLoop& loop, const std::array<double, 6>& pose, const ModeNumbers& mode,
             const std::array<double, kRequestJoints>& joints) {
            const auto& [x, y, height, roll, pitch, yaw] = pose;
            loop.request({.twist = {},
                          .posture = {.height = height, .roll = roll, .pitch = pitch, .x = x, .y = y, .yaw = yaw},
                          .mode = mode_of(mode),
                          .joints = joints});
          },
          "pose"_a, "mode"_a, "joints"_a)
      .def("e_stop", &ClosedLoop::e_stop)
      .def("e_stop_reset", &ClosedLoop::e_stop_reset)
      .def("heartbeat", &ClosedLoop::heartbeat)
      .def("clearance", &ClosedLoop::clearance, "metres"_a)
      .def("reset", &ClosedLoop::reset)
      .def("set_parameters", &ClosedLoop::set_parameters, "request"_a)
      .def("inject_fault", &ClosedLoop::inject_fault, "component"_a, "kind"_a)
      .def("clone", [](const ClosedLoop& loop) { return std::make_shared<ClosedLoop>(loop); })
      .def(
          "choose",
          [](const ClosedLoop& loop, const std::optional<std::vector<std::string>>& names) {
            return chosen_columns(loop.robot(), names);
          },
          "names"_a)
      .def("run", &run, "cycles"_a, "command"_a, "columns"_a, "replay"_a = nullptr)
      .def("record", &record, "commands"_a)
      .def("scan", &scan_of)
      .def("stop_distance", &distance_to_stop, "speed"_a, "emergency"_a)
      .def_property_readonly("smooth_speed", &smooth_speed_of)
      .def_property_readonly("period", [](const ClosedLoop& loop) { return loop.parameters().loop.period(); })
      .def_property_readonly("robot", [](const ClosedLoop& loop) { return describe(loop.robot().machine()); })
      .def_property_readonly(
          "gaits", [](const ClosedLoop& loop) { return gait_words(all_gaits(loop.parameters().leg_control.gaits)); })
      .def_property_readonly("warning", &ClosedLoop::warning)
      .def_property_readonly("fresh", &ClosedLoop::fresh)
      .def_property_readonly("cycle", &ClosedLoop::cycle)
      .def_property_readonly("time", &ClosedLoop::time)
      .def_property_readonly("columns", &column_meanings);
}

}  // namespace robot_control
