#include "bridge/inputs/command_senders.h"

#include <algorithm>

namespace robot_control {
namespace {

constexpr std::size_t kMostSenders = 16;  // whoever sends under ever new names takes no memory

}  // namespace

void CommandSenders::forget(std::int64_t now_ns) {
  const bool back = now_ns_ - now_ns > window_ns_;
  if (back) heard_ns_.clear();
  now_ns_ = back ? now_ns : std::max(now_ns, now_ns_);
  std::erase_if(heard_ns_, [&](const auto& heard) { return now_ns_ - heard.second > window_ns_; });
}

void CommandSenders::hear(const std::string& sender, std::int64_t now_ns) {
  forget(now_ns);
  heard_ns_[sender] = now_ns_;
  if (heard_ns_.size() <= kMostSenders) return;
  heard_ns_.erase(std::ranges::min_element(heard_ns_, {}, [](const auto& heard) { return heard.second; }));
}

std::vector<std::string> CommandSenders::at(std::int64_t now_ns) {
  forget(now_ns);
  std::vector<std::string> names;
  for (const auto& [name, heard] : heard_ns_) names.push_back(name);
  return names;
}

std::size_t CommandSenders::count(std::int64_t now_ns) {
  forget(now_ns);
  return heard_ns_.size();
}

}  // namespace robot_control
