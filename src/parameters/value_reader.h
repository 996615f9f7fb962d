#pragma once
/// One written value → one field, or one problem.

#include "parameters/parameter_tree.h"
#include "parameters/problem_list.h"
#include "parameters/schema/schema.h"

namespace robot_control {

/// Checks type, finiteness and range, then writes the field. False: refused, the problem was added.
/// Numbers are plain YAML numbers: a quoted "500" is a text.
bool read_value(const Entry& entry, const std::string& path, const Key& key, const Field& field, ProblemList& problems);

/// The word that replaced the old one that is written there; empty: it is none.
std::string_view word_now(const Entry& entry, const Field& field);

/// For messages: "500", "[a, b]", "(a block)".
std::string as_written(const Entry& entry);

}  // namespace robot_control
