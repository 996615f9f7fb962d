#pragma once
/// A CommandRelay decides which command unitree_bridge sends to the robot.
///
///   the driver's newest one     while it commands and the motion service is free
///   damping, with kp = 0        every kRepeatNs from kSilenceNs to kSilenceNs + kFoldNs after its last one
///   none                        else: a bridge without a driver leaves the motors to other programs

#include <cstdint>

#include "drivers/unitree_go/go_messages.h"

namespace robot_control::unitree::go {

class CommandRelay {
 public:
  static constexpr std::int64_t kSilenceNs = 20'000'000;
  static constexpr std::int64_t kRepeatNs = 2'000'000;
  static constexpr std::int64_t kFoldNs = 3'000'000'000;  ///< a robot that stands folds within 2 s

  /// `damping` in N·m·s/rad.
  explicit CommandRelay(double damping) : damping_(damping) {}

  /// Takes a command of the driver.
  void store(const LowCmd& command, std::int64_t now_ns) noexcept;

  /// Returns whether the driver sent a command since kSilenceNs + kFoldNs.
  bool has_driver(std::int64_t now_ns) const noexcept {
    return has_command_ && now_ns - command_ns_ <= kSilenceNs + kFoldNs;
  }

  /// Returns whether the robot got a command of this driver.
  bool sends() const noexcept { return sends_; }

  /// Returns the command that is due, or null. `may_send`: the motion service is free.
  const LowCmd* due(std::int64_t now_ns, bool may_send) noexcept;

  /// Returns damping for the motors of the last command that was sent, or null if none was.
  const LowCmd* last_command() noexcept;

 private:
  double damping_;
  LowCmd command_;
  std::int64_t command_ns_ = 0;
  std::int64_t damped_ns_ = 0;
  bool has_command_ = false;
  bool is_new_ = false;
  bool sends_ = false;
};

}  // namespace robot_control::unitree::go
