#pragma once
/// This refuses a numpy whose arrays the installed pybind11 misreads. Before version 2.12 it knows the arrays of
/// numpy 1 alone (pybind11's list of changes). With pybind11 2.10 and numpy 2.4 every row was silently the first.

#include <pybind11/pybind11.h>

#include <string>

namespace robot_control {

/// Each function that exchanges arrays calls it first, and a module of nothing else when it is loaded. Programs that
/// need names alone do without numpy.
/// Throws ImportError: the numpy that Python finds first has version 2 or later, and pybind11 is older than 2.12.
inline void check_numpy_version() {
#if PYBIND11_VERSION_HEX < 0x020C0000
  const auto numpy = pybind11::module_::import("numpy");
  const auto version = numpy.attr("__version__").cast<std::string>();
  if (std::stoi(version) < 2) return;
  throw pybind11::import_error(
      "numpy " + version + " of " + numpy.attr("__file__").cast<std::string>() +
      ": robot_control is built for the arrays of numpy 1; call /usr/bin/python3 with Debian's "
      "numpy (PYTHONNOUSERSITE=1 leaves out what pip has put into ~/.local)");
#endif
}

}  // namespace robot_control
