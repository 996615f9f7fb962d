#pragma once
/// The inputs of the loop: a velocity command, and an operator's requests.

#include <cstdint>

#include "signals/geometry.h"

namespace robot_control {

/// VelocityCommand::contested of what no sender sent: no request, and no end of a silence.
inline constexpr std::uint64_t kNoMessage = 2;

/// s without a message that count as a zero request, where cmd_vel_timeout is `timeout` s; 0: messages never time out.
inline double silence_needed(double timeout) noexcept {
  constexpr double kWithoutTimeout = 1;  // s
  return timeout > 0 ? timeout : kWithoutTimeout;
}

/// The last command on `cmd_vel` or `cmd_vel_stamped` that may be used, and how many may not. `count` grows by one with
/// every usable one: that, not a clock, distinguishes a new command from an old one. A stamp becomes an age once, when
/// the message arrives (bridge/inputs/command_input.h); from then on only cycles count, which no clock moves.
struct VelocityCommand {
  Twist twist;  ///< base axes; NaN and infinity are passed on, the controller refuses them
  std::uint64_t count = 0;
  std::int64_t age_ns = 0;         ///< ≥ 0, of the command when it arrived, by its stamp; 0 where it has none
  std::uint64_t stale = 0;         ///< grows with every message refused for its stamp: too old, or of the future
  std::uint64_t crowded = 0;       ///< grows with every message refused because more than one node sends
  std::uint64_t revoked = 0;       ///< grows with every message refused because its sender owes a zero velocity
  std::uint64_t many_senders = 0;  ///< 1: more than one node sends now, and one_sender forbids it

  /// 1: when the command arrived, another sender's newest message within silence_needed was not a zero velocity, or was
  /// refused. A zero velocity then is no evidence that no motion is requested.
  /// kNoMessage: not a message, but the zero velocity in force while no source commands (command_mux.h).
  std::uint64_t contested = 0;
};

/// The operator's inputs to the safety monitor. Each counter grows by one with every event.
struct OperatorInput {
  std::uint64_t e_stop_level = 0;     ///< 1: the last value of a publisher on topic `e_stop` is true
  std::uint64_t e_stop_messages = 0;  ///< on that topic, true or false
  std::uint64_t e_stop_triggers = 0;  ///< true on the topic
  std::uint64_t e_stop_services = 0;  ///< calls of `e_stop_trigger`
  std::uint64_t resets = 0;           ///< calls of `e_stop_reset`
  std::uint64_t heartbeats = 0;       ///< messages on `heartbeat`
  std::uint64_t clearances = 0;       ///< messages on `clearance`
  double clearance = 0;               ///< m, last value on topic `clearance`; as received, judged by the monitor
};

}  // namespace robot_control
