#pragma once
/// Several sources of commands → the controller's inbox: the words and rules of twist_mux. Pure.
///
///   live      its last accepted message is no older than the source's timeout (0: never too old)
///   locked    a lock of a higher priority is set: its last message said true, or with a timeout it is silent, or has
///             never said anything
///   winner    the live source of the highest priority that is not locked
///
/// The result is the winner's command, with the checks of CommandInput. Where there is no winner it is a zero velocity,
/// renewed at every look, so that nothing times out and the robot is at rest by command. When the winner changes, the
/// new one's last command takes effect at once; the controller's S-curve leads from one to the other. The evidence of a
/// zero request (safety/latch/motion_release.h) is that of the result; a zero because of a lock is contested while a
/// live source asks for motion, which would otherwise begin with the end of the lock.
///
/// Time is that of the loop's frames.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bridge/inputs/command_input.h"
#include "parameters/command_sources.h"

namespace robot_control {

class CommandMux {
 public:
  CommandMux(const CommandSourceList& list, bool one_sender);

  /// `source`: index in the list, which is sorted by priority.
  void receive(std::size_t source, const ArrivedCommand& arrived, const ArrivalTime& time);
  void receive_lock(std::size_t lock, bool set, std::int64_t loop_ns);

  /// Follows timeouts and locks. True if the value of the inbox changed.
  bool look(std::int64_t loop_ns);

  /// The value for the inbox.
  const VelocityCommand& value() const noexcept { return value_; }

  /// The new reports since the last call.
  std::vector<ReportLine> lines();

  /// Sorted by name.
  std::vector<std::string> senders(std::int64_t loop_ns);

  /// Name of the winner at the last look or message; empty: none.
  std::string winner() const;

  /// One text per source, by priority: "joy_vel: silent", "key_vel: commands", "cmd_vel: masked by key_vel",
  /// "path_vel: locked by pause".
  std::vector<std::string> states() const;

 private:
  struct Source {
    CommandSource given;
    CommandInput input;
    std::optional<std::int64_t> last_ns;  ///< when its last accepted message arrived
    bool live = false;
    std::optional<std::size_t> lock;  ///< that masks it
  };
  struct Lock {
    CommandLock given;
    std::optional<std::int64_t> last_ns;
    bool set = false;
    bool locks = false;
  };

  /// True if the winner changed.
  bool select(std::int64_t loop_ns);
  void take(const Source& source, std::int64_t loop_ns);
  void add_refusals();

  std::vector<Source> sources_;
  std::vector<Lock> locks_;
  std::optional<std::size_t> winner_;
  VelocityCommand value_;
  std::vector<ReportLine> lines_;
};

}  // namespace robot_control
