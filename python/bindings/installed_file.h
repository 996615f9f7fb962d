#pragma once
/// This returns the path of the installed parameter file, over which the user's file is laid.

#include <pybind11/pybind11.h>

#include <string>

namespace robot_control {

inline std::string installed_parameters() {
  return pybind11::module_::import("robot_control.installed_files")
      .attr("share_file")("config/robot_params.yaml")
      .cast<std::string>();
}

}  // namespace robot_control
