#pragma once
/// Several sources of commands → the controller's inbox: the words and rules of twist_mux. Pure.
///
///   live      its last accepted message is no older than the source's timeout (0: never too old)
///   locked    a lock of a higher priority is set: its last message was true, or it has a timeout and its
///             last message is older, or none was received
///   winner    the live source of the highest priority that is not locked
///
/// The result is the winner's command, with the checks of CommandInput. Where there is no winner it is a zero velocity,
/// renewed at every look, so that nothing times out and the robot is at rest by command. When the winner changes, the
/// new one's last command takes effect at once; the controller's S-curve leads from one to the other.
///
/// A source whose command was ended by the safety monitor (motion_requests.h) is not live until its next accepted
/// message, whatever its timeout.
///
/// Evidence that no motion is requested (safety/latch/motion_release.h) counts the messages of all sources: a zero
/// result is contested while any of them requests motion, masked or locked as it may be, because that motion would
/// begin with the silence of the winner or the end of the lock. The zero where there is no winner is no message
/// (kNoMessage), unless a locked source still requests motion.
///
/// Time is that of the loop's frames.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bridge/inputs/command_input.h"
#include "parameters/command_sources.h"

namespace robot_control {

class CommandMux final : public CommandIntake {
 public:
  /// `timeout`: cmd_vel_timeout, s; 0: never.
  CommandMux(const CommandSourceList& list, double timeout, bool one_sender);

  /// Sources have timeouts of their own; this is that of the evidence.
  void set_timeout(double timeout) override;

  void start(const EarlierController& earlier) override;

  /// `source`: index in the list, which is sorted by priority.
  void receive(std::size_t source, const ArrivedCommand& arrived, const ArrivalTime& time);
  void receive_lock(std::size_t lock, bool set, std::int64_t loop_ns);

  /// Follows timeouts and locks. True if the value of the inbox changed.
  bool look(std::int64_t loop_ns) override;

  bool follow(const MotionPermission& permission, std::int64_t loop_ns) override;
  std::vector<std::string> revoked() const override;

  const VelocityCommand& value() const noexcept override { return value_; }
  std::vector<ReportLine> lines() override;
  std::vector<std::string> senders(std::int64_t loop_ns) override;

  /// Name of the winner at the last look or message; empty: none.
  std::string winner() const override;

  /// One text per source, by priority: "joy_vel: silent", "key_vel: commands", "cmd_vel: masked by key_vel",
  /// "path_vel: locked by pause", "path_vel: revoked" (the motion of a sender is refused).
  std::vector<std::string> states() const override;

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
  /// `message`: because of one that arrived.
  void take_result(std::int64_t loop_ns, bool message);
  /// A message arrived within the last cycle: the controller may not have read it yet.
  bool unread(std::int64_t loop_ns) const;
  void add_refusals();

  std::vector<Source> sources_;
  std::vector<Lock> locks_;
  std::optional<std::size_t> winner_;
  std::optional<std::int64_t> message_ns_;  ///< when the last message arrived, of whatever source
  VelocityCommand value_;
  std::vector<ReportLine> lines_;
};

}  // namespace robot_control
