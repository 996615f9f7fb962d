#pragma once
/// "did you mean …?"

#include <string>
#include <string_view>

namespace robot_control {

/// Number of letters to insert, delete or replace to get from `a` to `b` (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known path nearest to "block.key" or "block.group.key", as a remedy; empty when nothing is near. A key of the
/// same block is named without it, one of another block with its block.
std::string suggest_key(std::string_view path);

/// The same for the name of a block.
std::string suggest_block(std::string_view name);

}  // namespace robot_control
