#pragma once
/// Determines the request of a cycle from the inbox of velocity commands.
///
/// A command is new if its count differs from the last one. It stays in force until `timeout` after its stamp; age_ns
/// is its age on arrival. Without a stamp, the cycle in which it was first read counts. It has timed out in cycle k if
///
///   (k − request_cycle)·period + age > timeout
///
/// Then the request is zero, and `timeouts` grows by one, once per command. A command with a NaN or infinite
/// component is refused. The request is then zero until the next valid command, without a timeout, and the
/// command before it is not resumed. The same holds while too many nodes send commands (VelocityCommand::many_senders),
/// and until the next command after that.
///
/// A command is accepted as a whole even if the machine cannot execute all of its parts. Parts that are not zero and
/// not executable are named (`ignored`), and such commands are counted (`partial`).
///
/// A message that is refused beside a command in force (VelocityCommand::stale, crowded, revoked, not_finite) has no
/// effect. That command stays in force until its own timeout. Commands that are overwritten in the inbox between two
/// cycles count as received; only the last one is evaluated. Only cycles are counted, so a clock that jumps cannot end
/// a command early or restore an old one.
///
/// The safety monitor (motion_release.h) uses this class as evidence that no motion is requested:
///
///   zero request    an accepted command, all of whose parts are zero, with VelocityCommand::contested 0; commands
///                   in the inbox before the first step do not count, because they may be as old as the process
///   zero requested  a zero request was received, and no other message since then
///   silent cycles   k − k_message; k_message is the cycle of the last message, accepted or refused, or of the first
///                   step if there was none. kNoMessage is not a message
///   silence needed  silence_needed (signals/velocity_command.h) in cycles

#include <cstdint>
#include <optional>

#include "signals/command_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

class CommandWatch {
 public:
  /// `timeout` is in s, 0 = never; `period` is in s, > 0. `executable`: RequestPart bits that the machine can execute.
  CommandWatch(double timeout, double period, std::uint64_t executable);

  /// Begins a new run. The inbox and everything before counts as not received. With `with_zero` the run begins with a
  /// zero request, because no older command can be pending (a command script, ClosedLoop).
  void enter_run(const VelocityCommand& inbox = {}, bool with_zero = false) noexcept;

  /// Sets another timeout, s, from the next step on; it also applies to the command in force.
  void set_timeout(double timeout) noexcept;

  /// Returns the request of this cycle, with the parts that the machine ignores.
  const Request& step(const VelocityCommand& request, std::uint64_t cycle) noexcept;

  /// Fills the counters of the frame and the evidence that the safety monitor reads.
  void report(std::uint64_t cycle, CommandFrame& out) const noexcept;

  /// Returns the CommandReason bits of the last step. They contain at most one of kReasonNoCommand, kReasonRefused,
  /// kReasonManySenders and kReasonTimedOut, and in addition kReasonStale, kReasonRevoked and kReasonPartIgnored.
  std::uint64_t reasons() const noexcept {
    return reason_ | without_effect_ | (ignored() != 0 ? std::uint64_t{kReasonPartIgnored} : 0);
  }
  /// Returns the RequestPart bits of the request that the robot cannot execute.
  std::uint64_t ignored() const noexcept { return ignored_; }
  std::uint64_t partial() const noexcept { return partial_; }  ///< accepted commands with an ignored part
  std::uint64_t request_cycle() const noexcept { return request_cycle_; }
  std::uint64_t received() const noexcept { return last_.count - first_.count + without_effect(); }
  std::uint64_t refused() const noexcept { return not_finite_ + without_effect(); }
  std::uint64_t stale() const noexcept { return last_.stale - first_.stale; }
  std::uint64_t crowded() const noexcept { return last_.crowded - first_.crowded; }
  std::uint64_t revoked() const noexcept { return last_.revoked - first_.revoked; }
  std::uint64_t timeouts() const noexcept { return timeouts_; }

  std::uint64_t first_cycle() const noexcept { return first_cycle_.value_or(0); }
  std::uint64_t zero_requests() const noexcept { return zero_requests_; }
  bool zero_requested() const noexcept { return zero_requested_; }
  std::uint64_t silent_cycles(std::uint64_t cycle) const noexcept { return cycle - message_cycle_; }
  std::uint64_t silence_needed() const noexcept { return silence_needed_; }

 private:
  /// `parts` are those of a new command.
  void accept(const VelocityCommand& request, std::uint64_t parts, std::uint64_t cycle) noexcept;
  void note_messages(const VelocityCommand& request, std::uint64_t parts, std::uint64_t cycle) noexcept;
  std::uint64_t without_effect() const noexcept {
    return stale() + crowded() + revoked() + last_.not_finite - first_.not_finite;
  }

  double timeout_;
  double period_;
  VelocityCommand first_;   ///< at the beginning of the run
  VelocityCommand last_;    ///< last one that was read
  std::uint64_t life_ = 0;  ///< cycles for which the last command stays in force
  std::uint64_t request_cycle_ = 0;
  std::uint64_t not_finite_ = 0;
  std::uint64_t timeouts_ = 0;
  std::uint64_t reason_ = 0;
  std::uint64_t without_effect_ = 0;  ///< kReasonStale and kReasonRevoked since the last accepted command
  Request requested_;
  std::uint64_t executable_;
  std::uint64_t ignored_ = 0;
  std::uint64_t partial_ = 0;
  std::optional<std::uint64_t> first_cycle_;  ///< cycle of the first step since `enter_run`
  std::uint64_t message_cycle_ = 0;
  std::uint64_t silence_needed_ = 0;
  std::uint64_t zero_requests_ = 0;
  bool zero_requested_ = false;
};

}  // namespace robot_control
