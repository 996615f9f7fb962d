#pragma once
/// diff_drive_controller → gate, monitor: what every joint shall do, and why it is not what was asked.

#include <array>
#include <cstdint>

#include "signals/frame_head.h"
#include "signals/geometry.h"
#include "signals/joint.h"

namespace robot_control {

/// Why the commanded motion differs from the requested one; bits of CommandFrame::reasons.
enum CommandReason : std::uint64_t {
  kReasonNoCommand = 1u << 0,     ///< Nothing received in this run yet.
  kReasonTimedOut = 1u << 1,      ///< The last command is older than cmd_vel_timeout.
  kReasonRefused = 1u << 2,       ///< The last command was NaN or infinite.
  kReasonSpeedLimited = 1u << 3,  ///< max_linear_speed or max_angular_speed.
  kReasonAccelerationLimited = 1u << 4,
  kReasonJerkLimited = 1u << 5,
  kReasonCurvatureKept = 1u << 6,  ///< One axis was scaled to keep the commanded curvature.
  kReasonSaturated = 1u << 7,      ///< A wheel's torque or speed is at its limit.
  kReasonNoPermit = 1u << 8,       ///< No live permit: brake.
  kReasonPermitBrake = 1u << 9,    ///< The permit orders the brake.
  kReasonPermitRamp = 1u << 10,    ///< The permit orders a ramp to standstill.
  kReasonNoState = 1u << 11,       ///< The state of this cycle was missing, held or invalid.
  kReasonBadSensors = 1u << 12,    ///< Joint samples missing or not finite: brake.
  kReasonHolding = 1u << 13,       ///< Standing with zero command: brake law holds the position.
  kReasonPermitSlow = 1u << 14,    ///< The permit's speed limit.
  kReasonJerkYielded = 1u << 15,   ///< Stopped at zero with more than the jerk limit, rather than beyond it.
  kReasonStale = 1u << 16,         ///< The last message was refused for its stamp; the command before it stands.
  kReasonManySenders = 1u << 17,   ///< More than one node sends, and one_sender forbids it.
  kReasonRevoked = 1u << 18,       ///< A sender requested motion before a withdrawal and has not sent zero since.
};

/// The gate executes a command in at most this many ticks: at tick k those of cycles k-kCommandLife … k-1.
inline constexpr std::uint64_t kCommandLife = 4;

struct CommandFrame {
  FrameHead head;
  std::uint64_t joint_count = 0;
  std::array<JointCommand, kMaxJoints> joints{};       ///< in the order of RobotModel::joints
  std::array<double, kMaxJoints> velocity_measured{};  ///< rad/s, of the tracking loop
  Twist twist_requested;                               ///< as last received; zero once timed out or refused
  Twist twist_limited;                                 ///< after limits: what the wheels are asked to do
  std::uint64_t reasons = 0;
  std::uint64_t state_cycle = 0;        ///< of the state used
  std::uint64_t permit_cycle = 0;       ///< of the permit used
  std::uint64_t request_cycle = 0;      ///< in which the last command was received
  std::uint64_t requests_received = 0;  ///< in this run
  std::uint64_t requests_refused = 0;   ///< in this run: NaN or infinite, or for one of the reasons below
  std::uint64_t requests_stale = 0;     ///< of these: for their stamp
  std::uint64_t requests_crowded = 0;   ///< of these: while more than one node sent
  std::uint64_t requests_revoked = 0;   ///< of these: of senders that owe a zero velocity (Permit::withdrawals)
  std::uint64_t timeouts = 0;           ///< in this run, one per event

  // What the monitor needs to know before it permits motion (safety/latch/motion_release.h).
  std::uint64_t first_cycle = 0;     ///< of this run, in which this process computed its first command
  std::uint64_t zero_requests = 0;   ///< zero velocities accepted since then, while no other sender requested motion
  std::uint64_t zero_requested = 0;  ///< 1: nothing but such zeros was received since the last of them
  std::uint64_t silent_cycles = 0;  ///< since the last message of any sender, accepted or refused, or since first_cycle
  std::uint64_t silence_needed = 0;  ///< cycles without a message after which no sender counts as requesting motion
};

}  // namespace robot_control
