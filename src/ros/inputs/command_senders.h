#pragma once
/// CommandSenders lists the nodes that sent a command within `window`. It is pure.
///
/// A node that only advertises cmd_vel is not a sender. Both topics of one node count as one sender. Time is that of
/// the loop's frames and independent of the system's clock. If it goes back by more than the window (a new simulation),
/// all senders are forgotten.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace robot_control {

class CommandSenders {
 public:
  /// Sets the window; `window_ns` > 0.
  void set_window(std::int64_t window_ns) { window_ns_ = window_ns; }

  void add(const std::string& sender, std::int64_t now_ns);

  /// Returns the senders with a message within the window, sorted by name.
  std::vector<std::string> at(std::int64_t now_ns);
  std::size_t count(std::int64_t now_ns);

 private:
  void forget(std::int64_t now_ns);

  std::int64_t window_ns_ = 0;
  std::int64_t now_ns_ = 0;
  std::map<std::string, std::int64_t> last_message_ns_;
};

}  // namespace robot_control
