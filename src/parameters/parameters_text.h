#pragma once
/// These functions write parameters as YAML, which is read back as the same values.

#include <span>
#include <string>

#include "parameters/schema.h"

namespace robot_control {

/// Returns the text of a complete file. Values that are left out, because they are derived, stay out.
std::string blocks_text(std::span<const Block> blocks);

/// Returns the YAML value; "" if an optional one is left out.
std::string value_text(const Field& field);

/// Returns a YAML scalar that is read back as the same number.
std::string yaml_number(double value);

/// Returns a YAML scalar that is read back as the same text, also if it looks like a number.
std::string yaml_quoted(const std::string& text);

}  // namespace robot_control
