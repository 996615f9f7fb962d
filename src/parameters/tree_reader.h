#pragma once
/// The values as they were written → structs: every rule of the schema, every contradiction.

#include <span>
#include <string>

#include "parameters/parameter_tree.h"
#include "parameters/parameters.h"
#include "parameters/problem_list.h"
#include "parameters/schema/schema.h"

namespace robot_control {

/// `base` with what `blocks` have in `tree`; what is refused or missing stays as in `base` and becomes a problem,
/// reported with the name `source` if it stands in no file. A loop rate that the tree does not contain is that of
/// `base`.
Parameters read_blocks(ParameterTree tree, std::span<const Block> blocks, const std::string& source,
                       const Parameters& base, ProblemList& problems);

}  // namespace robot_control
