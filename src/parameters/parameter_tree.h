#pragma once
/// The parameter values as text, before they are interpreted.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "parameters/parameters.h"
#include "parameters/problem_list.h"

namespace robot_control {

struct Entry {
  enum class Kind { kPlain, kQuoted, kNothing, kList, kMap };
  Kind kind = Kind::kNothing;
  std::string text;              ///< scalars only
  std::vector<Entry> items;      ///< lists only; kind and text of each
  std::string origin;            ///< "robot_params.yaml:12", or the overlay's own
  std::filesystem::path folder;  ///< what a relative path in it is relative to
  bool overlay = false;
  bool base = false;  ///< of the file below the file
};

struct BlockEntry {
  std::string name;
  std::string origin;
};

struct ParameterTree {
  std::map<std::string, Entry> entries;  ///< by path: "block.key" and, of a map, its keys' "block.key.inner", too
  std::vector<BlockEntry> blocks;        ///< those of the file
};

/// Reads the file (none if `yaml_path` is empty), then lays the overlays over it, the last one on top.
/// Unreadable and malformed YAML, duplicate keys and blocks that are no maps become problems. An overlay that is a map
/// is laid over key by key: what it does not name stays. So is the file over that of `base_path`, where one is there
/// and another. Every YAML tag (`!degrees`, `!!str`) is a problem: none is read.
ParameterTree read_tree(const std::string& yaml_path, const std::vector<Overlay>& overlays, ProblemList& problems,
                        const std::string& base_path = "");

/// Lays a request over the tree: the text of a YAML map of keys of `block`, of at most kMaxRequest bytes. Anything
/// else is one problem.
void lay_request_over(const std::string& block, const std::string& text, ParameterTree& tree, ProblemList& problems);

/// Bytes; every key of a block with a value needs a quarter of it.
inline constexpr std::size_t kMaxRequest = 4096;

}  // namespace robot_control
