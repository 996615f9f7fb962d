#pragma once
/// This reads a parameter file and the values that a Python program lays over it.

#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "configuration/parameters.h"

namespace robot_control {

using LayerValues = std::vector<std::pair<std::string, std::string>>;  ///< dotted path, YAML text

/// Returns the path of the installed parameter file, over which the user's file is laid.
inline std::string installed_parameters() {
  return pybind11::module_::import("robot_control.installed_files")
      .attr("share_file")("config/robot_params.yaml")
      .cast<std::string>();
}

/// Reads `values` over the file `path` over the file `base`; `origin` names the values in messages.
inline Parameters read_layers(const std::string& path, const LayerValues& values, const char* origin,
                              const std::string& base) {
  std::vector<Overlay> overlays;
  for (const auto& [key, text] : values) overlays.push_back({.path = key, .text = text, .origin = origin});
  return read_parameters(path, overlays, base);
}

/// As above, over the installed file unless `path` is empty.
inline Parameters read_layers(const std::string& path, const LayerValues& values, const char* origin) {
  return read_layers(path, values, origin, path.empty() ? "" : installed_parameters());
}

/// Reads the parameters of a ClosedLoop and passes their warnings on to Python.
inline Parameters parameters_from(const std::string& path, const LayerValues& values) {
  Parameters parameters = read_layers(path, values, "ClosedLoop");
  for (const std::string& text : parameters.warnings) {
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw pybind11::error_already_set();
  }
  return parameters;
}

}  // namespace robot_control
