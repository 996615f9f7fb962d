#include "bindings/bag.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>

#include "log/bag/bag_reader.h"

namespace py = pybind11;

namespace robot_control {
namespace {

py::dict connections(const BagReader& bag) {
  using namespace py::literals;
  py::dict all;
  for (const auto& [number, connection] : bag.connections()) {
    all[py::int_(number)] =
        py::dict("topic"_a = py::bytes(connection.topic), "type"_a = py::bytes(connection.type),
                 "md5sum"_a = py::bytes(connection.md5sum), "definition"_a = py::bytes(connection.definition));
  }
  return all;
}

/// Returns (connection, time of reception in ns, data) for each message of chunk `number` on these connections.
py::list messages(BagReader& bag, std::size_t number, const std::set<std::uint32_t>& wanted) {
  const BagChunk& chunk = bag.chunks().at(number);
  py::list all;
  const auto holds_any_of = [&](std::uint32_t connection) {
    return (chunk.connections >> (connection % 64U) & 1U) != 0;
  };
  if (std::none_of(wanted.begin(), wanted.end(), holds_any_of)) return all;
  bag.read(chunk, [&](const BagMessage& message) {
    if (wanted.contains(message.connection)) {
      all.append(py::make_tuple(message.connection, message.time_ns, py::bytes(message.data)));
    }
  });
  return all;
}

}  // namespace

void bind_bag(py::module_& module) {
  py::register_exception<BagError>(module, "BagError", PyExc_ValueError);
  py::class_<BagReader>(module, "BagReader")
      .def(py::init([](const std::string& path) {
             const py::gil_scoped_release release;
             return std::make_unique<BagReader>(path);
           }),
           py::arg("path"))
      .def_property_readonly("connections", &connections)
      .def_property_readonly("chunks", [](const BagReader& bag) { return bag.chunks().size(); })
      .def_property_readonly("count", &BagReader::messages)
      .def_property_readonly("cut", &BagReader::cut)
      .def("messages", &messages, py::arg("chunk"), py::arg("connections"));
}

}  // namespace robot_control
