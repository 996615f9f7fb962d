#pragma once
/// The values as they were written → structs: every rule of the schema, every contradiction.

#include <span>
#include <string>

#include "parameters/parameter_tree.h"
#include "parameters/parameters.h"
#include "parameters/problem_list.h"
#include "parameters/schema.h"

namespace robot_control {

/// `base` with what `blocks` have in `tree`; what is refused or missing stays as in `base` and becomes a problem,
/// reported of `source` where it stands nowhere. Of the loop's rate `base` knows where the tree does not.
Parameters read_blocks(ParameterTree tree, std::span<const Block> blocks, const std::string& source,
                       const Parameters& base, ProblemList& problems);

}  // namespace robot_control
