#pragma once
/// The level of the topic `e_stop`: one for each publisher, by the name of its node. Pure.
///
/// The topic is true while the last message of any publisher was true. Levels end as follows:
///   false of the same publisher   ends its level
///   a publisher that has left     keeps its level: its button may still be pressed. The level ends at the next reset
///                                 request (`settle`) if, after the last true, a publisher from which no message had
///                                 been received before sent false as its first message, as `rostopic pub -1` does
///
/// A publisher that always sends false therefore never ends the level of another one, and the end of a process releases
/// nothing. A level is no latch: what it stopped is released by e_stop_reset alone.

#include <map>
#include <set>
#include <string>
#include <vector>

namespace robot_control {

class EStopLevels {
 public:
  /// A message of this publisher. One that is no std_msgs/Bool counts as true.
  void receive(const std::string& publisher, bool stop);

  /// The last message of a publisher was true.
  bool stopped() const noexcept { return !levels_.empty(); }

  /// There are levels that end if their publishers have left.
  bool unsettled() const noexcept;

  /// Ends these levels where the publisher is not in `present`.
  void settle(const std::vector<std::string>& present);

  /// Whose last message was true, sorted.
  std::vector<std::string> publishers() const;

 private:
  std::map<std::string, bool> levels_;  ///< that are true; the value: a first message of another said false since
  std::set<std::string> known_;         ///< publishers of which a message was received
};

}  // namespace robot_control
