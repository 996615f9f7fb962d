#pragma once
/// These functions convert one written value into one field, or one problem.

#include "parameters/block.h"
#include "parameters/parameter_tree.h"
#include "parameters/problem_list.h"

namespace robot_control {

/// Checks type, finiteness and range, then writes the key's field. Returns false and adds a problem if the value is
/// refused. Numbers are plain YAML numbers; a quoted "500" is a text.
bool read_value(const Entry& entry, const std::string& path, const Key& key, ProblemList& problems);

/// Returns the present word if an old one is written, else "".
std::string_view word_now(const Entry& entry, const Field& field);

/// Returns the value for messages: "500", "[a, b]", "(a block)".
std::string as_written(const Entry& entry);

}  // namespace robot_control
