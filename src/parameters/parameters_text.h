#pragma once
/// These functions write parameters as the text of a complete YAML file, which read_parameters reads back as the same
/// values. Derived values are left out, and paths are absolute.

#include <string>

#include "parameters/parameters.h"

namespace robot_control {

std::string parameters_text(Parameters parameters);

/// Returns a YAML scalar that is read back as the same number.
std::string yaml_number(double value);

/// Returns a YAML scalar that is read back as the same text, also if it looks like a number.
std::string yaml_quoted(const std::string& text);

}  // namespace robot_control
