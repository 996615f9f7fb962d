#pragma once
/// EStopLevels holds one level of the topic `e_stop` per publisher, by the name of its node. It is pure.
///
/// The topic is true while the last message of any publisher was true. Levels end as follows:
///   false of the same publisher   ends its level
///   a publisher that has left     keeps its level: its button may still be pressed. The level ends at the next reset
///                                 request (`settle`) if, after the last true, a publisher from which no message had
///                                 been received before sent false as its first message, as `rostopic pub -1` does
///
/// A publisher that always sends false therefore never ends the level of another one, and the end of a process releases
/// nothing. A level is no latch: after the levels have ended, only e_stop_reset releases the robot.
///
/// After a restart of the monitor the publishers whose level was true are not known (`hold`), and may have left. The
/// topic then stays true until a reset request at which three conditions hold. Every present publisher has sent a
/// message since the restart. The first message of at least one of them was false. No level is true.

#include <map>
#include <set>
#include <string>
#include <vector>

namespace robot_control {

class EStopLevels {
 public:
  /// Applies a message of this publisher. A message that is no std_msgs/Bool counts as true.
  void receive(const std::string& publisher, bool stop);

  /// Returns whether the topic is true.
  bool stopped() const noexcept { return held_ || !levels_.empty(); }

  /// Records that the topic was true when an earlier monitor ended. It is called before the first message.
  void hold() { held_ = true; }

  /// Ends levels at a reset request, as described above; `present` are the present publishers. A publisher in `present`
  /// without a message no longer counts as new afterwards.
  void settle(const std::vector<std::string>& present);

  /// Returns the publishers whose last message was true, sorted. If the topic is held, those that have sent nothing
  /// since the restart follow.
  std::vector<std::string> publishers() const;

 private:
  bool remember(const std::string& publisher);

  std::map<std::string, bool> levels_;  ///< levels that are true; value: a new publisher has sent false since
  std::set<std::string> known_;         ///< publishers known by a message or by `settle`
  std::set<std::string> received_;      ///< publishers that have sent a message
  bool held_ = false;
  bool first_was_false_ = false;     ///< the first message of some publisher was false
  std::vector<std::string> silent_;  ///< publishers present at the last `settle` but not in received_
};

}  // namespace robot_control
