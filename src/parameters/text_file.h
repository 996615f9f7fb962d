#pragma once
/// This function reads a whole file as text.

#include <optional>
#include <string>

#include "parameters/problem_list.h"

namespace robot_control {

/// Returns nothing and adds a problem with `remedy` if the file cannot be read or is larger than `max_bytes`
/// (files/input_file.h).
std::optional<std::string> read_text_file(const std::string& path, std::size_t max_bytes, const std::string& remedy,
                                          ProblemList& problems);

}  // namespace robot_control
