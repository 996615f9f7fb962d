#pragma once
/// The requested twist of this cycle, from the inbox of velocity commands.
///
/// A command is new when its count differs from the last one. It stays in force until `timeout` after its stamp (age_ns
/// is its age on arrival); a command without a stamp, until `timeout` after the cycle in which it was first read. It
/// has timed out in cycle k if
///
///   (k − request_cycle)·period + age > timeout
///
/// Then the requested twist is zero, and `timeouts` grows by one, once per command. A command with a NaN or infinite
/// component is refused: the requested twist is zero until the next valid command (the command before it is not
/// resumed), and the refused command does not time out. The same holds while too many nodes send commands
/// (VelocityCommand::many_senders), and until the next command after that. A message that is refused for its stamp or
/// its sender (VelocityCommand::stale, revoked) has no effect: the command before it stays in force until its own
/// timeout. Commands that are overwritten in the inbox
/// between two cycles count as received; only the last one is evaluated.
///
/// Only cycles are counted here, so a clock that jumps cannot end a command early or restore an old one.
///
/// For the safety monitor (motion_release.h) this class also reports the evidence that no motion is requested:
///
///   zero request    an accepted command of zero velocity that is not contested (VelocityCommand::contested), received
///                   after the first step: what the inbox holds before may be as old as the process
///   zero requested  a zero request was received, and since then nothing else: no motion, no refused message, no
///                   contested zero
///   silent cycles   k − k_message, k_message the cycle of the last message of any sender, accepted or refused; before
///                   the first message the cycle of the first step. kNoMessage is not a message
///   silence needed  silence_needed (signals/velocity_command.h) in cycles

#include <cstdint>
#include <optional>

#include "signals/velocity_command.h"

namespace robot_control {

class CommandWatch {
 public:
  /// `timeout` s, 0 = never; `period` > 0, s.
  CommandWatch(double timeout, double period);

  /// A new run: what the inbox holds now, and everything before, counts as not received. `with_zero`: the run begins
  /// with a zero request, because no older command can be pending (a command script, ClosedLoop).
  void enter_run(const VelocityCommand& inbox = {}, bool with_zero = false) noexcept;

  /// Another timeout, s, from the next step on; it also applies to the command in force.
  void set_timeout(double timeout) noexcept;

  /// Returns the requested twist, of which a differential drive uses linear x and angular z.
  const Twist& step(const VelocityCommand& request, std::uint64_t cycle) noexcept;

  /// CommandReason bits of the last step: one of kReasonNoCommand, kReasonRefused, kReasonManySenders, kReasonTimedOut
  /// or none; in addition kReasonStale and kReasonRevoked.
  std::uint64_t reasons() const noexcept { return reason_ | without_effect_; }
  std::uint64_t request_cycle() const noexcept { return request_cycle_; }
  std::uint64_t received() const noexcept { return last_.count - first_.count + stale() + crowded() + revoked(); }
  std::uint64_t refused() const noexcept { return not_finite_ + stale() + crowded() + revoked(); }
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
  void accept(const VelocityCommand& request, std::uint64_t cycle) noexcept;
  void note_messages(const VelocityCommand& request, std::uint64_t cycle) noexcept;

  double timeout_;
  double period_;
  VelocityCommand first_;   ///< of the run
  VelocityCommand last_;    ///< read
  std::uint64_t life_ = 0;  ///< cycles for which the last command stays in force
  std::uint64_t request_cycle_ = 0;
  std::uint64_t not_finite_ = 0;
  std::uint64_t timeouts_ = 0;
  std::uint64_t reason_ = 0;
  std::uint64_t without_effect_ = 0;  ///< kReasonStale, kReasonRevoked: since the last accepted command
  Twist requested_twist_;
  std::optional<std::uint64_t> first_cycle_;  ///< of the first step since `enter_run`
  std::uint64_t message_cycle_ = 0;
  std::uint64_t silence_needed_ = 0;
  std::uint64_t zero_requests_ = 0;
  bool zero_requested_ = false;
};

}  // namespace robot_control
