#pragma once
/// read_blocks converts a tree of texts into structs; it applies every rule of the schema and finds every
/// contradiction.

#include <span>
#include <string>

#include "parameters/parameter_tree.h"
#include "parameters/parameters.h"
#include "parameters/problem_list.h"
#include "parameters/schema/schema.h"

namespace robot_control {

/// Returns `base` with the values of `blocks` in `tree`. A value that is refused or missing stays as in `base` and
/// becomes a problem. A value in no file is reported with the name `source`. If the tree has no loop rate, that of
/// `base` is used.
Parameters read_blocks(ParameterTree tree, std::span<const Block> blocks, const std::string& source,
                       const Parameters& base, ProblemList& problems);

}  // namespace robot_control
