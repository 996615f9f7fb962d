#pragma once
/// read_blocks writes the values of a tree of texts to their places; it applies every rule of the schema and finds
/// every contradiction.

#include <span>
#include <string>
#include <vector>

#include "parameters/parameter_tree.h"
#include "parameters/problem_list.h"
#include "parameters/schema.h"

namespace robot_control {

/// Reads the values of `blocks`, which are some or all of `schema`. A value that is refused or missing keeps its place
/// unchanged and becomes a problem. A value in no file is reported with the name `source`. Returns warnings about
/// accepted values in an old form.
std::vector<std::string> read_blocks(ParameterTree tree, const Schema& schema, std::span<const Block> blocks,
                                     const std::string& source, ProblemList& problems);

}  // namespace robot_control
