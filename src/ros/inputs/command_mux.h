#pragma once
/// CommandMux selects one of several command sources for the controller's inbox, with the terms and rules of twist_mux.
/// It is pure.
///
///   live      its last accepted message is no older than the source's timeout (0: never too old), by its stamp if it
///             has one
///   locked    a lock of a higher priority is set: its last message was true, or it has a timeout and received no
///             message within it
///   winner    the live source of the highest priority that is not locked
///
/// The result is the winner's command, with the checks of CommandInput. Without a winner it is a zero velocity, renewed
/// at every look: it never times out, and the robot is at rest by command. When the winner changes, the last command of
/// the new one takes effect at once; the controller's S-curve connects both.
///
/// A source whose command was ended by the safety monitor (motion_requests.h) is not live until its next accepted
/// message, whatever its timeout.
///
/// Evidence that no motion is requested (safety/latch/motion_release.h) depends on the messages of all sources. A zero
/// result is contested while any source requests motion, also a masked or locked one. Its motion would begin when the
/// winner becomes silent or the lock ends. The zero velocity without a winner is no message (kNoMessage), unless a
/// locked source still requests motion.
///
/// Time is that of the loop's frames.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "configuration/command_sources.h"
#include "ros/inputs/command_input.h"

namespace robot_control {

class CommandMux final : public CommandIntake {
 public:
  /// `timeout` is cmd_vel_timeout in s; 0 means that commands never time out.
  CommandMux(const CommandSourceList& list, double timeout, bool one_sender);

  /// Sets the timeout of the evidence; each source has a timeout of its own for its commands.
  void set_timeout(double timeout) override;

  void start(const EarlierController& earlier) override;

  /// `source` is an index of the list, which is sorted by priority.
  void receive(std::size_t source, const ArrivedCommand& arrived, const ArrivalTime& time);
  void receive_lock(std::size_t lock, bool set, std::int64_t loop_ns);

  /// Updates winner and value by timeouts and locks. Returns true if the value of the inbox changed.
  bool update(std::int64_t loop_ns) override;

  bool follow(const MotionPermission& permission, std::int64_t loop_ns) override;
  std::vector<std::string> revoked() const override;

  const VelocityCommand& value() const noexcept override { return value_; }
  std::vector<ReportLine> lines() override;
  std::vector<std::string> senders(std::int64_t loop_ns) override;

  /// Returns the name of the winner at the last look or message; "" if there was none.
  std::string winner() const override;

  /// Returns one text per source, by priority: "joy_vel: silent", "key_vel: commands", "cmd_vel: masked by key_vel",
  /// "path_vel: locked by pause", "path_vel: revoked". Revoked means that the motion of a sender is refused.
  std::vector<std::string> states() const override;

 private:
  struct Source {
    CommandSource given;
    CommandInput input;
    std::optional<std::int64_t> last_ns;  ///< when its last accepted message was stamped, or arrived
    bool live = false;
    std::optional<std::size_t> lock;  ///< lock that masks it
  };
  struct Lock {
    CommandLock given;
    std::optional<std::int64_t> last_ns;
    bool set = false;
    bool locks = false;
  };

  /// Selects the winner. Returns true if it changed.
  bool select(std::int64_t loop_ns);
  /// Adopts the winner's command; `message` says that a message caused the call.
  void update_result(std::int64_t loop_ns, bool message);
  /// Returns whether a message arrived within the last cycle, so that the controller may not have read it yet.
  bool unread(std::int64_t loop_ns) const;
  void add_refusals();

  std::vector<Source> sources_;
  std::vector<Lock> locks_;
  std::optional<std::size_t> winner_;
  std::optional<std::int64_t> message_ns_;  ///< when the last message of any source arrived
  std::int64_t unread_ns_ = unread_ns(0);
  VelocityCommand value_;
  std::vector<ReportLine> lines_;
};

}  // namespace robot_control
