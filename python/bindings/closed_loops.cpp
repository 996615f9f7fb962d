#include "simulation/closed_loops.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bindings/columns.h"
#include "bindings/layers.h"
#include "bindings/loop_bindings.h"
#include "bindings/numpy_version.h"

namespace py = pybind11;

namespace robot_control {
namespace {

using namespace py::literals;
using Commands = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Seeds = std::vector<std::uint64_t>;
using Which = std::vector<std::size_t>;

/// The rows are (linear, angular) or (linear, lateral, angular).
std::vector<Twist> twists_of(const Commands& commands, std::size_t loops) {
  const bool rows = commands.ndim() == 2 && static_cast<std::size_t>(commands.shape(0)) == loops;
  if (!rows || (commands.shape(1) != 2 && commands.shape(1) != 3)) {
    throw py::value_error("commands must have the shape (" + std::to_string(loops) +
                          ", 2), linear m/s and angular rad/s of each loop, or (" + std::to_string(loops) +
                          ", 3), linear, lateral and angular");
  }
  const auto number = commands.unchecked<2>();
  const py::ssize_t last = commands.shape(1) - 1;
  std::vector<Twist> twists(loops);
  for (py::ssize_t i = 0; i < commands.shape(0); ++i) {
    twists[static_cast<std::size_t>(i)] = {.linear = {number(i, 0), last == 2 ? number(i, 1) : 0, 0},
                                           .angular = {0, 0, number(i, last)}};
  }
  return twists;
}

/// Runs the cycles in blocks, between which Ctrl-C is noticed.
py::array_t<double> step(ClosedLoops& loops, std::uint64_t cycles, const std::optional<Commands>& commands,
                         const Columns& columns) {
  constexpr std::uint64_t kBlock = 1000;
  std::vector<Twist> twists = commands ? twists_of(*commands, loops.size()) : std::vector<Twist>();
  const std::size_t width = columns.chosen.size();
  py::array_t<double> values({loops.size(), width});
  const std::span<double> out(values.mutable_data(), loops.size() * width);
  std::uint64_t left = cycles;
  do {
    const std::uint64_t block = std::min(kBlock, left);
    {
      const py::gil_scoped_release release;
      loops.step(block, twists, columns.chosen, out);
    }
    twists.clear();
    left -= block;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  } while (left > 0);
  return values;
}

}  // namespace

void bind_closed_loops(py::module_& module) {
  py::class_<ClosedLoops>(module, "ClosedLoops")
      .def(py::init([](const std::string& path, const LayerValues& values, const Seeds& seeds, std::size_t threads) {
             check_numpy_version();
             const Parameters parameters = parameters_from(path, values);
             const py::gil_scoped_release release;
             return std::make_unique<ClosedLoops>(parameters, seeds, threads);
           }),
           "path"_a, "values"_a, "seeds"_a, "threads"_a)
      .def(
          "clone",
          [](const ClosedLoops& loops, const Which& which, std::size_t threads) {
            return std::make_unique<ClosedLoops>(loops, which, threads);
          },
          "which"_a, "threads"_a, py::call_guard<py::gil_scoped_release>())
      .def(
          "reset", [](ClosedLoops& loops, const Which& which, const Seeds& seeds) { loops.reset(which, seeds); },
          "which"_a, "seeds"_a, py::call_guard<py::gil_scoped_release>())
      .def("step", &step, "cycles"_a, "commands"_a, "columns"_a)
      .def(
          "loop", [](const ClosedLoops& loops, std::size_t i) { return loops.loop(i); }, "i"_a);
}

}  // namespace robot_control
