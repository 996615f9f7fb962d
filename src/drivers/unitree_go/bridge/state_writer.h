#pragma once
/// A StateWriter distinguishes the robot from others that send states on the same DDS network, by their DDS writers.
///
/// The first writer is the robot's. A robot that restarts has a new writer: after kRememberedNs without a state of the
/// old one, the next writer is the robot's. Its states must come for kKnownNs before it counts as the only one, because
/// DDS finds several robots one after the other.

#include <cstdint>

#include "drivers/unitree_go/bridge_report.h"

namespace robot_control::unitree::go {

class StateWriter {
 public:
  static constexpr std::int64_t kRememberedNs = 1'000'000'000;
  static constexpr std::int64_t kKnownNs = 500'000'000;

  /// Takes the writer of a state, and returns whether it is the robot's.
  bool is_of_robot(std::uint64_t writer, std::int64_t now_ns) noexcept {
    const bool is_silent = now_ns - state_ns_ >= kRememberedNs;
    if (writer != writer_ && !is_silent) {
      other_ns_ = now_ns;
      return false;
    }
    if (is_silent) begin_ns_ = now_ns;
    writer_ = writer;
    state_ns_ = now_ns;
    return true;
  }

  RobotsSeen robots(std::int64_t now_ns) const noexcept {
    if (now_ns - other_ns_ < kRememberedNs) return RobotsSeen::kMore;
    if (now_ns - state_ns_ >= kRememberedNs) return RobotsSeen::kNone;
    return now_ns - begin_ns_ < kKnownNs ? RobotsSeen::kAwaited : RobotsSeen::kOne;
  }

 private:
  std::uint64_t writer_ = 0;  // 0: none
  std::int64_t begin_ns_ = 0;
  std::int64_t state_ns_ = -kRememberedNs;
  std::int64_t other_ns_ = -kRememberedNs;
};

}  // namespace robot_control::unitree::go
