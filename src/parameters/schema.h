#pragma once
/// A Schema holds all keys of a YAML file with the places of their values. It is composed of the blocks that are
/// declared beside the laws (block.h), and belongs to the structs from which it was made.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "parameters/block.h"

namespace robot_control {

struct Block {
  std::string_view name;
  Keys keys;
};

struct Schema {
  std::vector<Block> blocks = {};
  /// Checks the rules across keys after every value was read.
  std::function<void(const Schema& schema, GivenValues& given)> check = [](const Schema&, GivenValues&) {};

  /// Returns the remedy for a key of another package ("wheel_radius_multiplier"); "" if no such package has it.
  std::string (*other_package_remedy)(std::string_view key) = [](std::string_view) { return std::string(); };
};

/// Returns "block.key" or "block.group.key".
std::string path_of(const Block& block, const Key& key);

/// Returns "block.group"; "" if the key is in the block itself.
std::string group_path_of(const Block& block, const Key& key);

/// Returns the rule for a group's path, "a map of limit, persistence, reaction"; "" if there is no such group.
std::string rule_of_group(const Schema& schema, std::string_view path);

/// Returns the allowed values in words: "a number of 100 … 2000 Hz", "one of wall, lockstep".
std::string rule_of(const Key& key);

}  // namespace robot_control
