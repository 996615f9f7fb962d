#include "parameters/live_parameters.h"

#include <algorithm>
#include <utility>

#include "files/ascii.h"
#include "parameters/parameter_tree.h"
#include "parameters/problem_list.h"
#include "parameters/schema/schema.h"
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

std::vector<Key> live_keys(const Block& block) {
  std::vector<Key> keys;
  std::ranges::copy_if(block.keys, std::back_inserter(keys), [](const Key& key) { return (key.traits & kLive) != 0; });
  return keys;
}

Entry in_force(Entry::Kind kind, std::string text = {}) {
  Entry entry;
  entry.kind = kind;
  entry.text = std::move(text);
  entry.origin = "in force";
  return entry;
}

/// Returns the values in force as a tree, as if a file contained them.
ParameterTree tree_in_force(Parameters base, const Block& block) {
  ParameterTree tree;
  for (const Key& key : block.keys) {
    const std::string group = group_path_of(block, key);
    if (!group.empty()) tree.entries[group] = in_force(Entry::Kind::kMap);
    const Value value = value_of(key.field(base));
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
    problems.add({path, as_written(entry), "is read at start alone", entry.origin,
                  "set it in the YAML file or on the parameter server and start the node again"});
  }
}

}  // namespace

std::vector<LiveParameter> live_parameters(const Parameters& whole, const std::string& block_name) {
  Parameters parameters = whole;
  const Block& block = *std::ranges::find(schema(), block_name, &Block::name);
  std::vector<LiveParameter> live;
  for (const Key& key : live_keys(block)) {
    const Value value = value_of(key.field(parameters));
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
  const Block& whole = *std::ranges::find(schema(), block_name, &Block::name);
  const std::vector<Key> keys = live_keys(whole);
  const Block block{whole.name, keys};
  Parameters before = base;
  ParameterTree tree = tree_in_force(base, block);
  ProblemList problems;
  lay_request_over(block_name, text, tree, problems);
  refuse_fixed(whole, tree, problems);
  LiveChange change;
  change.parameters = read_blocks(tree, {&block, 1}, "request", base, problems);
  for (const Key& key : keys) {
    const std::string path = path_of(block, key);
    const Value value = value_of(key.field(change.parameters));
    if (!given(tree, path) || !value) continue;
    change.values.push_back({.key = path.substr(block_name.size() + 1),
                             .value = *value,
                             .before = text_of(value_of(key.field(before))),
                             .after = text_of(value)});
  }
  if (problems.empty() && change.values.empty()) {
    problems.add({"request", printable(text), "names no value", "", "for example {max_linear_speed: 0.5}"});
  }
  change.problems = problems.lines();
  return change;
}

}  // namespace robot_control
