#pragma once
/// Selects the command for the controller: the newest one (CommandInput), or that of the winner among several sources
/// (CommandMux). Pure; time is that of the loop's frames.

#include <cstdint>
#include <string>
#include <vector>

#include "bridge/inputs/motion_requests.h"
#include "bridge/reports/command_report.h"
#include "signals/velocity_command.h"

namespace robot_control {

class CommandIntake {
 public:
  CommandIntake() = default;
  CommandIntake(const CommandIntake&) = default;
  CommandIntake(CommandIntake&&) = default;
  CommandIntake& operator=(const CommandIntake&) = default;
  CommandIntake& operator=(CommandIntake&&) = default;
  virtual ~CommandIntake() = default;

  /// Before the first message and the first call of `follow`.
  virtual void start(const EarlierController& earlier) = 0;

  /// Follows what happens without a message: silence. True if the value of the inbox changed.
  virtual bool look(std::int64_t loop_ns) = 0;

  /// Follows the safety monitor; before each message that arrives, and at least at every `look`. True if the command in
  /// force ended (motion_requests.h).
  virtual bool follow(const MotionPermission& permission, std::int64_t loop_ns) = 0;

  /// Names of the senders whose motion is refused until their next zero velocity, whether they request one or not.
  virtual std::vector<std::string> revoked() const = 0;

  /// The value for the inbox.
  virtual const VelocityCommand& value() const noexcept = 0;

  /// The new reports since the last call.
  virtual std::vector<ReportLine> lines() = 0;

  /// Sorted by name.
  virtual std::vector<std::string> senders(std::int64_t loop_ns) = 0;

  /// Another cmd_vel_timeout, s.
  virtual void set_timeout(double timeout) = 0;

  /// The source that commands; empty: none, or there is no list.
  virtual std::string winner() const { return {}; }

  /// One text per source of a list.
  virtual std::vector<std::string> states() const { return {}; }
};

}  // namespace robot_control
