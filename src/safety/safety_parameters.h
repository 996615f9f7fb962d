#pragma once
/// What a user sets of the safety monitor.

#include <cstdint>

namespace robot_control {

struct SafetyParameters {
  std::uint64_t loss_cycles = 20;  ///< cycles without a command or a state before the stop latches
  double heartbeat_timeout = 0;    ///< s; 0 = no operator heartbeat is asked for
  double ramp_time = 2.0;          ///< s, longest category-1 ramp before the brake
  double standstill_speed = 0.05;  ///< rad/s, wheels slower than this are standing
};

}  // namespace robot_control
