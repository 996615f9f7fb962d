#pragma once
/// The parameter file of the installed package, over which one of the user's is laid.

#include <pybind11/pybind11.h>

#include <string>

namespace robot_control {

inline std::string installed_parameters() {
  return pybind11::module_::import("robot_control.installed_files")
      .attr("share_file")("config/robot_params.yaml")
      .cast<std::string>();
}

}  // namespace robot_control
