#include "ros/inputs/e_stop_levels.h"

#include <algorithm>

#include "signals/roles.h"

namespace robot_control {
namespace {

// This bounds the memory that a sender with ever new names can take. All further publishers share one level, which no
// false message ends.
constexpr std::size_t kMaxPublishers = 1000;
const char* const kFurther = "(further publishers)";
const std::string kRestarted = std::string(program_of(Role::kMonitor)) + " was restarted";
const std::string kSilent = " (has published nothing since " + kRestarted + ")";
const std::string kUnknown = "an unknown publisher, from before " + kRestarted;

}  // namespace

/// Returns whether the publisher is new and was stored; false if it was known or there are too many.
bool EStopLevels::remember(const std::string& publisher) {
  return known_.size() < kMaxPublishers && known_.insert(publisher).second;
}

void EStopLevels::receive(const std::string& publisher, bool stop) {
  const bool first = remember(publisher);
  const bool further = !known_.contains(publisher);
  if (!further && received_.insert(publisher).second && !stop) first_was_false_ = true;
  if (stop) {
    levels_.insert_or_assign(further ? kFurther : publisher, false);
    return;
  }
  levels_.erase(publisher);
  if (!first) return;
  for (auto& [other, withdrawn] : levels_) withdrawn = true;
}

void EStopLevels::settle(const std::vector<std::string>& present) {
  std::erase_if(levels_, [&](const auto& level) {
    return level.second && std::ranges::find(present, level.first) == present.end();
  });
  silent_.clear();
  for (const std::string& publisher : present) {
    remember(publisher);
    if (!received_.contains(publisher)) silent_.push_back(publisher);
  }
  if (silent_.empty() && first_was_false_ && levels_.empty()) held_ = false;
}

std::vector<std::string> EStopLevels::publishers() const {
  std::vector<std::string> names;
  for (const auto& [name, withdrawn] : levels_) names.push_back(name);
  if (!held_) return names;
  for (const std::string& name : silent_) names.push_back(name + kSilent);
  if (names.empty()) names.emplace_back(kUnknown);
  return names;
}

}  // namespace robot_control
