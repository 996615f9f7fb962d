#pragma once
/// A ParameterTree holds the parameter values as text, before they are interpreted.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "parameters/problem_list.h"

namespace YAML {
class Node;
}

namespace robot_control {

/// One value that is laid over the file: path "robot.rate", YAML text "500", origin "/robot/rate". A condition of the
/// safety monitor is a map. The path "block.tilt.limit" sets one value of it, "block.tilt" all values
/// that the text names.
struct Overlay {
  std::string path;
  std::string text;  ///< a scalar, or a list or a map in brackets; an empty text is the empty string
  std::string origin;
};

struct Entry {
  enum class Kind { kPlain, kQuoted, kNothing, kList, kMap };
  Kind kind = Kind::kNothing;
  std::string text;              ///< scalars only
  std::vector<Entry> items;      ///< lists only; each item has kind and text
  std::string origin;            ///< "robot_params.yaml:12", or the origin of the overlay
  std::filesystem::path folder;  ///< folder to which a relative path refers
  bool overlay = false;
  bool base = false;  ///< the value is that of the base file
};

struct BlockEntry {
  std::string name;
  std::string origin;
};

struct ParameterTree {
  std::map<std::string, Entry> entries;  ///< by path: "block.key", and "block.key.inner" for each key of a map
  std::vector<BlockEntry> blocks;        ///< blocks of the file
};

/// Reads the file (none if `yaml_path` is empty), then lays the overlays over it, the last one on top. Unreadable and
/// malformed YAML, duplicate keys and blocks that are no maps become problems. An overlay that is a map replaces only
/// the keys that it names. In the same way the file is laid over that of `base_path`, if that is another file and
/// exists. Every YAML tag (`!degrees`, `!!str`) is a problem, because tags have no effect. A file in which `foreign`
/// finds a problem, because it is one of another package, has this problem alone.
ParameterTree read_tree(const std::string& yaml_path, const std::vector<Overlay>& overlays, ProblemList& problems,
                        std::optional<Problem> (*foreign)(const std::string& path, const YAML::Node& root),
                        const std::string& base_path = "");

/// Adds a map of blocks, which stands in the file `source`. A path in it refers to `folder`.
void read_document(const YAML::Node& root, const std::string& source, const std::filesystem::path& folder,
                   ParameterTree& tree, ProblemList& problems);

/// Lays a request over the tree. The request is the text of a YAML map of keys of `block`, with at most kMaxRequest
/// bytes. Any other text is one problem.
void lay_request_over(const std::string& block, const std::string& text, ParameterTree& tree, ProblemList& problems);

/// A request has at most this many bytes. All keys of a block with values need a quarter of it.
inline constexpr std::size_t kMaxRequest = 4096;

}  // namespace robot_control
