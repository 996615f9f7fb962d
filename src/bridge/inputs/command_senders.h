#pragma once
/// Who sends commands: every node that was heard within `window`, by its name. Pure.
///
/// Heard, not registered: a node that merely advertises cmd_vel commands nothing. Both topics of one node are one
/// sender. Time is that of the loop's frames, so that no clock moves it; should it turn back by more than the window (a
/// new simulation), all are forgotten.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace robot_control {

class CommandSenders {
 public:
  /// `window_ns` > 0.
  void limit(std::int64_t window_ns) { window_ns_ = window_ns; }

  void hear(const std::string& sender, std::int64_t now_ns);

  /// As if this one had not been heard.
  void drop(const std::string& sender) { heard_ns_.erase(sender); }

  /// Those heard within the window, sorted by name.
  std::vector<std::string> at(std::int64_t now_ns);
  std::size_t count(std::int64_t now_ns);

 private:
  void forget(std::int64_t now_ns);

  std::int64_t window_ns_ = 0;
  std::int64_t now_ns_ = 0;
  std::map<std::string, std::int64_t> heard_ns_;
};

}  // namespace robot_control
