#include "bindings/loop_replay.h"

#include <pybind11/stl.h>

#include <memory>
#include <string>

namespace py = pybind11;

namespace robot_control {
using namespace py::literals;

void LoopReplay::store(const ClosedLoop& loop) {
  for (const LawSnapshot* snapshot : loop.snapshots()) {
    if (snapshot == nullptr) continue;
    const auto copy = std::make_unique<LawSnapshot>(*snapshot);
    seal(*copy);
    replay_.add(*copy);
  }
  encode_trace({.row = loop.row(), .joints = joints_}, messages_.emplace_back());
}

void LoopReplay::check() {
  TraceRow row;
  for (const std::string& message : messages_) {
    decoder_.decode(message, row);
    replay_.add(row, message, 0);
  }
  messages_.clear();
}

py::dict LoopReplay::report() {
  check();
  return described(replay_.report());
}

py::dict described(const ReplayReport& report) {
  py::dict laws;
  for (std::size_t i = 0; i < kLaws; ++i) {
    const LawReport& law = report.laws[i];
    laws[py::str(name_of(static_cast<LawName>(i)))] =
        py::dict("compared"_a = law.compared, "different"_a = law.different, "not_compared"_a = law.not_compared,
                 "missing"_a = law.missing);
  }
  py::list differences, gaps;
  for (const ReplayDifference& difference : report.differences) differences.append(sentence(difference));
  for (const ReplayGap& gap : report.gaps) gaps.append(sentence(gap));
  return py::dict("exact"_a = report.exact(), "laws"_a = laws, "rows"_a = report.rows,
                  "different_rows"_a = report.different_rows, "damaged_snapshots"_a = report.damaged_snapshots,
                  "differences"_a = differences, "gaps"_a = gaps);
}

void bind_loop_replay(py::module_& module) {
  py::class_<LoopReplay>(module, "LoopReplay")
      .def(py::init<ClosedLoop&>(), "loop"_a)
      .def("check", &LoopReplay::check, py::call_guard<py::gil_scoped_release>())
      .def("report", &LoopReplay::report);
}

}  // namespace robot_control
