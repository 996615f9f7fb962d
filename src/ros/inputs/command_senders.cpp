#include "ros/inputs/command_senders.h"

#include <algorithm>

namespace robot_control {
namespace {

constexpr std::size_t kMaxSenders = 16;  // bounds the memory that a sender with ever new names can take

}  // namespace

void CommandSenders::forget(std::int64_t now_ns) {
  const bool back = now_ns_ - now_ns > window_ns_;
  if (back) last_message_ns_.clear();
  now_ns_ = back ? now_ns : std::max(now_ns, now_ns_);
  std::erase_if(last_message_ns_, [&](const auto& entry) { return now_ns_ - entry.second > window_ns_; });
}

void CommandSenders::add(const std::string& sender, std::int64_t now_ns) {
  forget(now_ns);
  last_message_ns_[sender] = now_ns_;
  if (last_message_ns_.size() <= kMaxSenders) return;
  last_message_ns_.erase(
      std::ranges::min_element(last_message_ns_, {}, [](const auto& entry) { return entry.second; }));
}

std::vector<std::string> CommandSenders::at(std::int64_t now_ns) {
  forget(now_ns);
  std::vector<std::string> names;
  for (const auto& [name, time] : last_message_ns_) names.push_back(name);
  return names;
}

std::size_t CommandSenders::count(std::int64_t now_ns) {
  forget(now_ns);
  return last_message_ns_.size();
}

}  // namespace robot_control
