#pragma once
/// What the operator wants in this cycle: the inbox, judged.
///
/// A message is new when its count differs from the last one seen. It stands for `timeout` from the cycle in which
/// it was first seen: in cycle k it has timed out when (k − request_cycle)·period > timeout; then the wish is zero
/// and `timeouts` grows by one, once per message. A message with any component NaN or infinite is refused: the wish
/// is zero until a good one arrives (what was commanded before is not resumed), and it does not time out. Messages
/// overwritten in the inbox between two cycles count as received; only the last one is judged.

#include <cstdint>

#include "signals/velocity_command.h"

namespace robot_control {

class CommandWatch {
 public:
  /// `timeout` s, 0 = never; `period` > 0, s.
  CommandWatch(double timeout, double period);

  /// A new run: what the inbox holds now, and whatever came before, counts as not received.
  void reset(std::uint64_t request_count) noexcept;

  /// Returns what the robot shall do; linear x and angular z matter to a differential drive.
  const Twist& step(const VelocityCommand& request, std::uint64_t cycle) noexcept;

  /// CommandReason bit of the last step: kReasonNoCommand, kReasonRefused, kReasonTimedOut or 0.
  std::uint64_t reasons() const noexcept { return reason_; }
  std::uint64_t request_cycle() const noexcept { return request_cycle_; }
  std::uint64_t received() const noexcept { return last_count_ - first_count_; }
  std::uint64_t refused() const noexcept { return refused_; }
  std::uint64_t timeouts() const noexcept { return timeouts_; }

 private:
  std::uint64_t timeout_cycles_;
  std::uint64_t first_count_ = 0;
  std::uint64_t last_count_ = 0;
  std::uint64_t request_cycle_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t timeouts_ = 0;
  std::uint64_t reason_ = 0;
  Twist wish_;
};

}  // namespace robot_control
