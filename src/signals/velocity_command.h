#pragma once
/// What enters the loop from outside: a wished motion, and an operator's requests.

#include <cstdint>

#include "signals/geometry.h"

namespace robot_control {

/// The last message on `cmd_vel`. `count` grows by one with every message received: that, not a clock,
/// tells a new message from an old one.
struct VelocityCommand {
  Twist twist;  ///< base axes; NaN and infinity are passed on, the controller refuses them
  std::uint64_t count = 0;
};

/// The operator's inputs to the safety monitor. Each counter grows by one with every event.
struct OperatorInput {
  std::uint64_t e_stop_level = 0;     ///< last value on topic `e_stop`: 1 = true
  std::uint64_t e_stop_messages = 0;  ///< on that topic, true or false
  std::uint64_t e_stop_triggers = 0;  ///< true on the topic
  std::uint64_t e_stop_services = 0;  ///< calls of `e_stop_trigger`
  std::uint64_t resets = 0;           ///< calls of `e_stop_reset`
  std::uint64_t heartbeats = 0;       ///< messages on `heartbeat`
  std::uint64_t clearances = 0;       ///< messages on `clearance`
  double clearance = 0;               ///< m, last value on topic `clearance`; as received, judged by the monitor
};

}  // namespace robot_control
