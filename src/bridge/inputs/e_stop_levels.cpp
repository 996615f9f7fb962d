#include "bridge/inputs/e_stop_levels.h"

#include <algorithm>

namespace robot_control {
namespace {

// A sender under ever new names takes bounded memory. What is sent under further names is true for ever: no false ends
// it.
constexpr std::size_t kMostPublishers = 1000;
const char* const kFurther = "(further publishers)";

}  // namespace

void EStopLevels::receive(const std::string& publisher, bool stop) {
  const bool full = known_.size() >= kMostPublishers && !known_.contains(publisher);
  const bool first = !full && known_.insert(publisher).second;
  if (stop) {
    levels_.insert_or_assign(full ? kFurther : publisher, false);
    return;
  }
  levels_.erase(publisher);
  if (!first) return;
  for (auto& [other, withdrawn] : levels_) withdrawn = true;
}

bool EStopLevels::unsettled() const noexcept {
  return std::ranges::any_of(levels_, [](const auto& level) { return level.second; });
}

void EStopLevels::settle(const std::vector<std::string>& present) {
  std::erase_if(levels_, [&](const auto& level) {
    return level.second && std::ranges::find(present, level.first) == present.end();
  });
}

std::vector<std::string> EStopLevels::publishers() const {
  std::vector<std::string> names;
  for (const auto& [name, withdrawn] : levels_) names.push_back(name);
  return names;
}

}  // namespace robot_control
