#include "robot/collada_nodes.h"

#include <algorithm>
#include <map>
#include <vector>

namespace robot_control {
namespace {

struct Node {
  std::vector<std::size_t> children;
  std::vector<std::string> instances;
};

/// The tags of a text one after the other; comments, CDATA, instructions and declarations are passed over.
class Tags {
 public:
  explicit Tags(std::string_view xml) : rest_(xml) {}

  /// Without its angle brackets; empty at the end.
  std::string_view next() {
    while (true) {
      rest_.remove_prefix(std::min(rest_.find('<'), rest_.size()));
      if (rest_.empty()) return {};
      if (skip("<!--", "-->") || skip("<![CDATA[", "]]>") || skip("<?", "?>") || skip("<!", ">")) continue;
      const std::size_t end = end_of_tag();
      const std::string_view tag = rest_.substr(1, end - 1);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      if (!tag.empty()) return tag;
    }
  }

 private:
  bool skip(std::string_view begin, std::string_view end) {
    if (!rest_.starts_with(begin)) return false;
    const std::size_t at = rest_.find(end, begin.size());
    rest_.remove_prefix(at == std::string_view::npos ? rest_.size() : at + end.size());
    return true;
  }

  std::size_t end_of_tag() const {
    char quote = 0;
    for (std::size_t i = 1; i < rest_.size(); ++i) {
      const char c = rest_[i];
      if (quote != 0) {
        if (c == quote) quote = 0;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '>') {
        return i;
      }
    }
    return rest_.size();
  }

  std::string_view rest_;
};

constexpr std::string_view kSpace = " \t\r\n";

std::string_view name_of(std::string_view tag) {
  return tag.substr(0, tag.find_first_of(" \t\r\n/", 1));
}

std::string attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    std::string_view rest = tag.substr(at + name.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(kSpace), rest.size()));
    if (kSpace.find(tag[at - 1]) == std::string_view::npos || !rest.starts_with('=')) continue;
    rest.remove_prefix(std::min(rest.find_first_of("\"'"), rest.size()));
    if (rest.empty()) return {};
    return std::string(rest.substr(1, rest.find(rest[0], 1) - 1));
  }
  return {};
}

class NodeTree {
 public:
  /// False: elements nest too deep.
  bool read(std::string_view xml) {
    Tags tags(xml);
    std::vector<std::size_t> open;  // nodes
    int depth = 0;
    for (std::string_view tag = tags.next(); !tag.empty(); tag = tags.next()) {
      const bool closes = tag.front() == '/';
      const bool is_whole = tag.back() == '/';
      const std::string_view name = closes ? name_of(tag.substr(1)) : name_of(tag);
      depth += closes ? -1 : is_whole ? 0 : 1;
      if (depth > kDeepestElement) return false;
      if (name == "node" && closes) {
        if (!open.empty()) open.pop_back();
      } else if (name == "node") {
        add(tag, open);
        if (!is_whole) open.push_back(nodes_.size() - 1);
      } else if (name == "instance_node" && !closes && !open.empty()) {
        const std::string url = attribute(tag, "url");
        nodes_[open.back()].instances.push_back(url.starts_with('#') ? url.substr(1) : url);
      }
    }
    return true;
  }

  bool can_be_followed() {
    std::size_t visits = 0;
    return std::all_of(roots_.begin(), roots_.end(), [&](std::size_t root) { return follow(root, 1, visits); });
  }

 private:
  void add(std::string_view tag, const std::vector<std::size_t>& open) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    if (open.empty()) {
      roots_.push_back(index);
    } else {
      nodes_[open.back()].children.push_back(index);
    }
    // assimp finds a node by its name, too
    for (const char* key : {"id", "name"}) {
      if (const std::string called = attribute(tag, key); !called.empty()) named_[called].push_back(index);
    }
  }

  bool follow(std::size_t index, int depth, std::size_t& visits) {
    if (depth > kDeepestElement || ++visits > kMostNodes) return false;
    for (const std::size_t child : nodes_[index].children) {
      if (!follow(child, depth + 1, visits)) return false;
    }
    for (const std::string& name : nodes_[index].instances) {
      const auto found = named_.find(name);
      if (found == named_.end()) continue;
      for (const std::size_t target : found->second) {
        if (!follow(target, depth + 1, visits)) return false;
      }
    }
    return true;
  }

  std::vector<Node> nodes_;
  std::vector<std::size_t> roots_;
  std::map<std::string, std::vector<std::size_t>> named_;
};

}  // namespace

std::string collada_node_problem(std::string_view xml) {
  NodeTree tree;
  if (!tree.read(xml)) return "its elements nest deeper than " + std::to_string(kDeepestElement);
  if (!tree.can_be_followed()) return "its <instance_node> stand for each other in a circle or without measure";
  return {};
}

}  // namespace robot_control
