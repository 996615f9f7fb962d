#include "configuration/live_parameters.h"

#include <algorithm>
#include <utility>

#include "files/ascii.h"
#include "parameters/tree_reader.h"
#include "parameters/value_reader.h"

namespace robot_control {
namespace {

using Value = std::optional<std::variant<double, bool>>;

Value value_of(const Field& field) {
  if (const auto* number = std::get_if<double*>(&field)) return **number;
  if (const auto* number = std::get_if<std::optional<double>*>(&field)) {
    if (**number) return ***number;
    return {};
  }
  return **std::get_if<bool*>(&field);
}

std::string text_of(const Value& value) {
  if (!value) return "derived";
  if (const auto* number = std::get_if<double>(&*value)) return shortest(*number);
  return std::get<bool>(*value) ? "true" : "false";
}

const Block& block_named(const std::string& name, const Schema& schema) {
  return *std::ranges::find(schema.blocks, name, &Block::name);
}

Block live_part(Block block) {
  std::erase_if(block.keys, [](const Key& key) { return (key.traits & kLive) == 0; });
  return block;
}

Entry in_force(Entry::Kind kind, std::string text = {}) {
  Entry entry;
  entry.kind = kind;
  entry.text = std::move(text);
  entry.origin = "in force";
  return entry;
}

/// Returns the values in force as a tree, as if a file contained them.
ParameterTree tree_in_force(const Block& block) {
  ParameterTree tree;
  for (const Key& key : block.keys) {
    const std::string group = group_path_of(block, key);
    if (!group.empty()) tree.entries[group] = in_force(Entry::Kind::kMap);
    const Value value = value_of(key.field);
    if (value) tree.entries[path_of(block, key)] = in_force(Entry::Kind::kPlain, text_of(value));
  }
  return tree;
}

bool given(const ParameterTree& tree, const std::string& path) {
  const auto entry = tree.entries.find(path);
  return entry != tree.entries.end() && entry->second.overlay;
}

void refuse_fixed(const Block& block, const ParameterTree& tree, ProblemList& problems) {
  for (const Key& key : block.keys) {
    const std::string path = path_of(block, key);
    if ((key.traits & kLive) != 0 || !given(tree, path)) continue;
    const Entry& entry = tree.entries.at(path);
    problems.add({path, as_written(entry), "is read only at start", entry.origin,
                  "set it in the YAML file or on the parameter server and restart the node"});
  }
}

}  // namespace

std::vector<LiveParameter> live_parameters(const Parameters& whole, const std::string& block_name) {
  Parameters parameters = whole;
  const Block block = live_part(block_named(block_name, schema(parameters)));
  std::vector<LiveParameter> live;
  for (const Key& key : block.keys) {
    const Value value = value_of(key.field);
    if (!value) continue;
    live.push_back({.key = path_of(block, key).substr(block_name.size() + 1),
                    .value = *value,
                    .min = (key.traits & kZeroIsOff) != 0 ? 0 : key.min,
                    .max = key.max,
                    .rule = ascii(rule_of(key))});
  }
  return live;
}

LiveChange read_live(const Parameters& base, const std::string& block_name, const std::string& text) {
  LiveChange change;
  change.parameters = base;
  const Schema all = schema(change.parameters);
  const Block& whole = block_named(block_name, all);
  const Block block = live_part(whole);
  std::vector<std::string> before;
  for (const Key& key : block.keys) before.push_back(text_of(value_of(key.field)));
  ParameterTree tree = tree_in_force(block);
  ProblemList problems;
  lay_request_over(block_name, text, tree, problems);
  refuse_fixed(whole, tree, problems);
  read_blocks(tree, all, {&block, 1}, "request", problems);
  for (std::size_t i = 0; i < block.keys.size(); ++i) {
    const std::string path = path_of(block, block.keys[i]);
    const Value value = value_of(block.keys[i].field);
    if (!given(tree, path) || !value) continue;
    change.values.push_back(
        {.key = path.substr(block_name.size() + 1), .value = *value, .before = before[i], .after = text_of(value)});
  }
  if (problems.empty() && change.values.empty()) {
    problems.add({"request", printable(text), "names no value", "", "for example {max_linear_speed: 0.5}"});
  }
  change.problems = problems.lines();
  return change;
}

}  // namespace robot_control
