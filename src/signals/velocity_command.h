#pragma once
/// The loop has two inputs: a command with what the machine shall do, and an operator's requests.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "signals/geometry.h"

namespace robot_control {

/// The ways of moving of all kinds of machines. A machine names one that it does not know (kReasonPartIgnored).
enum class ModeKind : std::uint64_t {
  kStay = 0,    ///< the default of the machine; on legs: stand with all feet, or lie, as before
  kLie = 1,     ///< on legs
  kStand = 2,   ///< on legs
  kLift = 3,    ///< on legs: Mode::index is the LegPlace of the foot in the air.
  kJoints = 4,  ///< on legs: Request::joints are the targets of the joints while the robot lies.
  kGait = 5,    ///< on legs: Mode::index is the gait (control/legged/walk/gait_table.h).
};

struct Mode {
  ModeKind kind = ModeKind::kStay;
  std::uint64_t index = 0;

  bool operator==(const Mode&) const = default;
};

/// The posture of the base relative to the nominal one, which is all zero. A mode may give it to another part of the
/// machine, such as a foot.
struct Posture {
  double height = 0;  ///< m
  double roll = 0;    ///< rad
  double pitch = 0;   ///< rad
  double x = 0;       ///< m, to the front
  double y = 0;       ///< m, to the left
  double yaw = 0;     ///< rad

  bool operator==(const Posture&) const = default;
};

/// A request names the positions of at most this many joints.
inline constexpr std::size_t kRequestJoints = 12;

/// A request states what a machine shall do. The machine executes the parts that it can execute; the controller names
/// the others (CommandFrame::ignored).
struct Request {
  Twist twist{};  ///< base axes
  Posture posture{};
  Mode mode{};
  std::array<double, kRequestJoints> joints{};  ///< rad or m, of the driven joints; used by modes that move joints
};

/// The parts of a request; bits of CommandFrame::ignored.
enum RequestPart : std::uint64_t {
  kPartLinearX = 1u << 0,
  kPartLinearY = 1u << 1,
  kPartLinearZ = 1u << 2,
  kPartAngularX = 1u << 3,
  kPartAngularY = 1u << 4,
  kPartAngularZ = 1u << 5,
  kPartHeight = 1u << 6,
  kPartRoll = 1u << 7,
  kPartPitch = 1u << 8,
  kPartMode = 1u << 9,
  kPartX = 1u << 10,
  kPartY = 1u << 11,
  kPartYaw = 1u << 12,
  kPartJoints = 1u << 13,
};

/// The numbers of twist and posture in the order of their RequestPart bits, without kPartMode.
inline std::array<double, 12> numbers_of(const Request& request) noexcept {
  const auto& [linear, angular] = request.twist;
  const Posture& to = request.posture;
  return {linear[0], linear[1], linear[2], angular[0], angular[1], angular[2],
          to.height, to.roll,   to.pitch,  to.x,       to.y,       to.yaw};
}

/// Returns the RequestPart bits of the parts that are not zero.
inline std::uint64_t parts_of(const Request& request) noexcept {
  std::uint64_t parts = request.mode != Mode{} ? std::uint64_t{kPartMode} : 0;
  std::uint64_t part = kPartLinearX;
  for (const double number : numbers_of(request)) {
    if (number != 0) parts |= part;
    part <<= part == kPartPitch ? 2 : 1;  // kPartMode lies between
  }
  if (std::ranges::any_of(request.joints, [](double joint) { return joint != 0; })) parts |= kPartJoints;
  return parts;
}

inline bool finite(const Request& request) noexcept {
  const auto is_finite = [](double number) { return std::isfinite(number); };
  return std::ranges::all_of(numbers_of(request), is_finite) && std::ranges::all_of(request.joints, is_finite);
}

/// Returns the number of joints that the log writes of a request: all, or none where each is zero.
inline std::size_t logged_joints(const Request& request) noexcept {
  const bool any =
      std::ranges::any_of(request.joints, [](double joint) { return std::bit_cast<std::uint64_t>(joint) != 0; });
  return any ? kRequestJoints : 0;
}

/// Values of VelocityCommand::contested. A command with kNoMessage has no sender, and is neither a request nor the end
/// of a silence. With kNotFiniteMessage, a message of its sender was refused because it was NaN or infinite. The value
/// is kNotFiniteBefore when another message arrives meanwhile.
inline constexpr std::uint64_t kNoMessage = 2, kNotFiniteMessage = 3, kNotFiniteBefore = 4;

/// Returns how many seconds without a message count as a zero request; `timeout` is cmd_vel_timeout in s, 0 if messages
/// never time out.
inline double silence_needed(double timeout) noexcept {
  constexpr double kWithoutTimeout = 1;  // s
  return timeout > 0 ? timeout : kWithoutTimeout;
}

/// The last usable command on `cmd_vel` or `cmd_vel_stamped`, with counts of refused ones. `count` grows by one with
/// every usable command, so that no clock is needed to recognise a new one. When a message arrives, its stamp is
/// converted to an age (ros/inputs/command_input.h). From then on its age is counted in cycles, independent of any
/// clock.
struct VelocityCommand {
  Request content;
  std::uint64_t count = 0;
  std::int64_t age_ns = 0;         ///< ≥ 0, age of the command at its arrival by its stamp; 0 without a stamp
  std::uint64_t stale = 0;         ///< grows with every message refused for its stamp: too old, or in the future
  std::uint64_t crowded = 0;       ///< grows with every message refused because another node sends
  std::uint64_t revoked = 0;       ///< grows with every message refused because its sender is revoked
  std::uint64_t not_finite = 0;    ///< grows with every message that was NaN or infinite and ended at most a pose
  std::uint64_t many_senders = 0;  ///< 1: several nodes send, one requests motion, and one_sender forbids it

  /// 1 if, when the command arrived, another sender's newest message within silence_needed was refused or not of zero
  /// velocity. Then a zero velocity is no evidence that no motion is requested. The value is kNoMessage for the zero
  /// velocity that is in force while no source commands (command_mux.h), or because a command ended. If that command
  /// arrived so recently that the controller may not have read it, the value is 1 instead. It is kNotFiniteMessage for
  /// a zero velocity in place of a refused message.
  std::uint64_t contested = 0;
};

/// The operator's inputs to the safety monitor. Each counter grows by one with every event.
struct OperatorInput {
  std::uint64_t e_stop_level = 0;     ///< 1: the last value of a publisher on topic `e_stop` is true
  std::uint64_t e_stop_messages = 0;  ///< messages on that topic, true or false
  std::uint64_t e_stop_triggers = 0;  ///< messages `true` on that topic
  std::uint64_t e_stop_services = 0;  ///< calls of `e_stop_trigger`
  std::uint64_t resets = 0;           ///< calls of `e_stop_reset`
  std::uint64_t heartbeats = 0;       ///< messages on `heartbeat`
  std::uint64_t clearances = 0;       ///< messages on `clearance`
  double clearance = 0;               ///< m, last value on topic `clearance` as received; the monitor checks it
};

}  // namespace robot_control
