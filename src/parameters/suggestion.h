#pragma once
/// These functions suggest known names for a misspelt one: "did you mean …?"

#include <string>
#include <string_view>

#include "parameters/schema.h"

namespace robot_control {

/// Returns how many letters must be inserted, deleted or replaced to change `a` into `b` (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// Returns the known path nearest to "block.key" or "block.group.key" as a remedy; "" if none is near. A key of the
/// same block is named without the block, one of another block with it. A key of another package comes first.
std::string suggest_key(const Schema& schema, std::string_view path);

/// Returns the nearest name of a block as a remedy; "" if none is near.
std::string suggest_block(const Schema& schema, std::string_view name);

}  // namespace robot_control
