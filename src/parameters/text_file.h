#pragma once
/// A whole file as text.

#include <optional>
#include <string>

#include "parameters/problem_list.h"

namespace robot_control {

/// Nothing, and a problem with `remedy`, when it cannot be read or is larger than `most` bytes (files/input_file.h).
std::optional<std::string> read_text_file(const std::string& path, std::size_t max_bytes, const std::string& remedy,
                                          ProblemList& problems);

}  // namespace robot_control
