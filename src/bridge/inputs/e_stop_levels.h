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
///
/// After a restart of safety_monitor it is not known whose level was true (`hold`). The topic then stays true until the
/// next reset request at which every publisher that is there has sent a message since the restart, the first message of
/// one since then was false, and no level is true: who said true may have left.

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
  bool stopped() const noexcept { return held_ || !levels_.empty(); }

  /// The topic was true when an earlier safety_monitor ended. Before the first message.
  void hold() { held_ = true; }

  /// At a reset request, with the publishers that are there: ends the levels that end now. A publisher in `present`
  /// from which no message was received is no new one any more.
  void settle(const std::vector<std::string>& present);

  /// Whose last message was true, sorted; then, of a topic that is held, who has sent nothing since.
  std::vector<std::string> publishers() const;

 private:
  bool remember(const std::string& publisher);

  std::map<std::string, bool> levels_;  ///< that are true; the value: a first message of another said false since
  std::set<std::string> known_;         ///< publishers that were seen, by a message or by `settle`
  std::set<std::string> received_;      ///< publishers of which a message was received
  bool held_ = false;
  bool first_was_false_ = false;     ///< the first message that was received of some publisher
  std::vector<std::string> silent_;  ///< of those that were there at the last `settle`, not in received_
};

}  // namespace robot_control
