#include "parameters/suggestion.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace robot_control {
namespace {

// Returns the largest edit distance of a suggestion: two letters, or a third of a long word.
std::size_t farthest(std::string_view word) {
  return std::max<std::size_t>(2, word.size() / 3);
}

std::string question(const std::string& word) {
  return word.empty() ? "" : "did you mean " + word + "?";
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string suggest_key(const Schema& schema, std::string_view path) {
  const std::size_t dot = path.find('.');
  const std::string_view block_name = path.substr(0, dot);
  const std::string_view key_name = dot == std::string_view::npos ? path : path.substr(dot + 1);
  if (std::string remedy = schema.other_package_remedy(key_name); !remedy.empty()) return remedy;
  constexpr std::size_t kMaxWord = 100;
  if (key_name.size() > kMaxWord) return {};
  std::size_t nearest = farthest(key_name) + 1;
  std::string word;
  const auto consider = [&](const Block& block, const std::string& candidate) {
    const bool here = block.name == block_name;
    const std::string name = candidate.substr(block.name.size() + 1);
    const std::size_t distance = edit_distance(key_name, name) + (here ? 0 : 1);
    if (distance >= nearest) return;
    nearest = distance;
    word = here ? name : candidate;
  };
  for (const Block& block : schema.blocks) {
    for (const Key& key : block.keys) {
      if (!key.group.empty()) consider(block, group_path_of(block, key));
      consider(block, path_of(block, key));
    }
  }
  return question(word);
}

std::string suggest_block(const Schema& schema, std::string_view name) {
  std::size_t nearest = farthest(name) + 1;
  std::string word;
  for (const Block& block : schema.blocks) {
    const std::size_t distance = edit_distance(name, block.name);
    if (distance >= nearest) continue;
    nearest = distance;
    word = block.name;
  }
  return question(word);
}

}  // namespace robot_control
