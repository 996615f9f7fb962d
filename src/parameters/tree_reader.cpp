#include "parameters/tree_reader.h"

#include <set>

#include "parameters/parameters_text.h"
#include "parameters/suggestion.h"
#include "parameters/value_reader.h"

namespace robot_control {
namespace {

class TreeReader : public GivenValues {
 public:
  TreeReader(ParameterTree tree, const Schema& schema, std::span<const Block> blocks, std::string source,
             ProblemList& problems)
      : tree_(std::move(tree)), schema_(schema), blocks_(blocks), source_(std::move(source)), problems_(problems) {}

  std::vector<std::string> read() {
    higher_layers_replace_other_names();
    refuse_unknown();
    for (const Block& block : blocks_) {
      for (const Key& key : block.keys) read_key(block, key);
    }
    for (const Block& block : blocks_) {
      for (const Key& key : block.keys) {
        if (!key.other_name_of.empty()) check_other_name(block, key);
      }
    }
    schema_.check(schema_, *this);
    return std::move(warnings_);
  }

  bool accepted(const std::string& path) const override { return accepted_.contains(path); }

  bool refused(const std::string& path) const override { return tree_.entries.contains(path) && !accepted(path); }

  std::string shown(const std::string& path) const override {
    const Entry& entry = tree_.entries.at(path);
    return path + " = " + as_written(entry) + " [" + entry.origin + "]";
  }

  void refuse(const std::string& path, const std::string& rule, const std::string& remedy) override {
    const Entry& entry = tree_.entries.at(path);
    problems_.add({path, as_written(entry), rule, entry.origin, remedy});
  }

 private:
  // wheel_separation and wheel_base name one value: if a higher layer sets one name, the other name is removed from the
  // lower layers.
  void higher_layers_replace_other_names() {
    for (const Block& block : schema_.blocks) {
      for (const Key& key : block.keys) {
        if (key.other_name_of.empty()) continue;
        const std::string one = path_of(block, key);
        const std::string other = std::string(block.name) + "." + std::string(key.other_name_of);
        if (layer_of(one) > layer_of(other)) tree_.entries.erase(other);
        if (layer_of(other) > layer_of(one)) tree_.entries.erase(one);
      }
    }
  }

  /// Returns the layer that gives the value: 0 none, 1 the base file, 2 the file, 3 an overlay.
  int layer_of(const std::string& path) const {
    const auto entry = tree_.entries.find(path);
    if (entry == tree_.entries.end()) return 0;
    return entry->second.overlay ? 3 : entry->second.base ? 1 : 2;
  }

  void refuse_unknown() {
    std::set<std::string, std::less<>> blocks;
    std::set<std::string, std::less<>> paths;
    for (const Block& block : schema_.blocks) {
      blocks.emplace(block.name);
      for (const Key& key : block.keys) paths.insert(path_of(block, key));
    }
    // Keys inside an unexpected or unknown map are reported with that map. A server can hold keys below a key whose
    // value in the file is no map; these are reported themselves.
    const auto reported_with_its_map = [&](const std::string& path) {
      const std::string map = path.substr(0, path.rfind('.'));
      const auto entry = tree_.entries.find(map);
      return map.find('.') != std::string::npos && entry != tree_.entries.end() &&
             entry->second.kind == Entry::Kind::kMap && rule_of_group(schema_, map).empty();
    };
    for (const BlockEntry& block : tree_.blocks) {
      if (blocks.contains(block.name)) continue;
      problems_.add({printable(block.name), "", "unknown block", block.origin, suggest_block(schema_, block.name)});
    }
    for (const auto& [path, entry] : tree_.entries) {
      const bool reported_with_its_block = !entry.overlay && !blocks.contains(path.substr(0, path.find('.')));
      if (paths.contains(path) || !rule_of_group(schema_, path).empty()) continue;
      if (reported_with_its_block || reported_with_its_map(path)) continue;
      problems_.add({printable(path), as_written(entry), "unknown key", entry.origin, suggest_key(schema_, path)});
    }
  }

  void read_key(const Block& block, const Key& key) {
    const std::string path = path_of(block, key);
    const std::string group = group_path_of(block, key);
    if (!group.empty() && !group_is_there(group)) return;
    const auto entry = tree_.entries.find(path);
    if (entry != tree_.entries.end()) {
      if (read_value(entry->second, path, key, problems_)) accepted_.insert(path);
      if (const std::string_view now = word_now(entry->second, key.field); !now.empty()) {
        warnings_.push_back(path + " = " + as_written(entry->second) + " is an old value: replace it with " +
                            std::string(now) + " [" + entry->second.origin + "]");
      }
      if ((key.traits & kObsolete) != 0) {
        warnings_.push_back(path + " has no effect any more: remove it [" + entry->second.origin + "]");
      }
    } else if ((key.traits & kOptional) == 0) {
      const auto map = tree_.entries.find(group);
      const std::string& place = map == tree_.entries.end() ? source_ : map->second.origin;
      problems_.add({path, "", "missing", place, "add it: " + rule_of(key)});
    }
  }

  // Returns whether all keys of the group are optional.
  bool may_be_absent(const std::string& group) const {
    for (const Block& block : schema_.blocks) {
      for (const Key& key : block.keys) {
        if (group_path_of(block, key) == group && (key.traits & kOptional) == 0) return false;
      }
    }
    return true;
  }

  // Returns whether the map of the group exists. If it is missing or no map, this is one problem instead of one per
  // key.
  bool group_is_there(const std::string& group) {
    const auto entry = tree_.entries.find(group);
    const bool map = entry != tree_.entries.end() && entry->second.kind == Entry::Kind::kMap;
    const auto first_inside = tree_.entries.lower_bound(group + ".");
    const bool overlaid_alone = entry == tree_.entries.end() && first_inside != tree_.entries.end() &&
                                first_inside->first.starts_with(group + ".");
    if (map || overlaid_alone) return true;
    if (entry == tree_.entries.end() && may_be_absent(group)) return false;
    if (!reported_groups_.insert(group).second) return false;
    const std::string rule = rule_of_group(schema_, group);
    if (entry == tree_.entries.end()) {
      problems_.add({group, "", "missing", source_, "add it: " + rule});
    } else {
      problems_.add({group, as_written(entry->second), "must be " + rule, entry->second.origin, ""});
    }
    return false;
  }

  // Both names write to one place, so their values are compared as texts.
  void check_other_name(const Block& block, const Key& key) {
    const std::string path = path_of(block, key);
    const std::string other = std::string(block.name) + "." + std::string(key.other_name_of);
    if (!accepted(path) || !accepted(other)) return;
    const auto text_of = [&](const std::string& name) {
      ProblemList none;
      read_value(tree_.entries.at(name), name, key, none);
      return value_text(key.field);
    };
    if (text_of(other) == text_of(path)) return;
    refuse(path, "is another name of " + shown(other) + " and differs", "remove one of them");
  }

  ParameterTree tree_;
  const Schema& schema_;
  std::span<const Block> blocks_;
  std::string source_;  ///< origin in the message about a missing value
  ProblemList& problems_;
  std::vector<std::string> warnings_;
  std::set<std::string, std::less<>> accepted_;         ///< paths
  std::set<std::string, std::less<>> reported_groups_;  ///< groups that are no maps
};

}  // namespace

std::vector<std::string> read_blocks(ParameterTree tree, const Schema& schema, std::span<const Block> blocks,
                                     const std::string& source, ProblemList& problems) {
  return TreeReader(std::move(tree), schema, blocks, source, problems).read();
}

}  // namespace robot_control
