#pragma once
/// Parameters → the text of a complete YAML file that read_parameters reads back as the same values: what was left out
/// and derived is left out again, paths are absolute.

#include <string>

#include "parameters/parameters.h"

namespace robot_control {

std::string parameters_text(Parameters parameters);

/// A YAML scalar that reads back as the same number.
std::string yaml_number(double value);

/// A YAML scalar that reads back as the same text, also if it looks like a number.
std::string yaml_quoted(const std::string& text);

}  // namespace robot_control
