#pragma once
/// A CommandIntake selects the command for the controller: the newest one (CommandInput), or that of the winner among
/// several sources (CommandMux). It is pure; time is that of the loop's frames.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "ros/inputs/motion_requests.h"
#include "ros/reports/report_line.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// Returns for how many ns of the loop's time the controller may not have read a message: a period, at least 10 ms.
constexpr std::int64_t unread_ns(std::int64_t period_ns) noexcept {
  constexpr std::int64_t kUnread = 10'000'000;
  return std::max(kUnread, period_ns);
}

class CommandIntake {
 public:
  CommandIntake() = default;
  CommandIntake(const CommandIntake&) = default;
  CommandIntake(CommandIntake&&) = default;
  CommandIntake& operator=(const CommandIntake&) = default;
  CommandIntake& operator=(CommandIntake&&) = default;
  virtual ~CommandIntake() = default;

  /// Sets the situation at the start; is called before the first message and the first call of `follow`.
  virtual void start(const EarlierController& earlier) = 0;

  /// Updates the value for the time that has passed without a message. Returns true if the value of the inbox changed.
  virtual bool update(std::int64_t loop_ns) = 0;

  /// Applies the safety monitor's permission. It is called before each message and at least at every `update`. Returns
  /// true if the command in force ended (motion_requests.h).
  virtual bool follow(const MotionPermission& permission, std::int64_t loop_ns) = 0;

  /// Returns the names of the senders whose motion is refused until their next zero velocity, whether they request
  /// motion or not.
  virtual std::vector<std::string> revoked() const = 0;

  /// Returns the value for the inbox.
  virtual const VelocityCommand& value() const noexcept = 0;

  /// Returns the reports since the last call.
  virtual std::vector<ReportLine> lines() = 0;

  /// Returns the senders of commands, sorted by name.
  virtual std::vector<std::string> senders(std::int64_t loop_ns) = 0;

  /// Sets another cmd_vel_timeout in s.
  virtual void set_timeout(double timeout) = 0;

  /// Returns the source that commands; "" if none does, or if there is no list.
  virtual std::string winner() const { return {}; }

  /// Returns one text per source of the list.
  virtual std::vector<std::string> states() const { return {}; }
};

}  // namespace robot_control
