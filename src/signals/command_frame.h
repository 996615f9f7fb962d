#pragma once
/// The controller sends this frame to gate and monitor: the commands of all joints, and why they differ from the
/// request.

#include <array>
#include <cstdint>

#include "signals/contact.h"
#include "signals/frame_head.h"
#include "signals/geometry.h"
#include "signals/joint.h"
#include "signals/legged/legged_command.h"
#include "signals/velocity_command.h"
#include "signals/wheeled/wheeled_command.h"

namespace robot_control {

/// Why the commanded motion differs from the requested one; bits of CommandFrame::reasons. Each kind of robot has
/// bits of its own behind these; signals/names.h checks that no two share a bit. A bit keeps its meaning in all logs.
enum CommandReason : std::uint64_t {
  kReasonNoCommand = 1u << 0,     ///< Nothing received in this run yet.
  kReasonTimedOut = 1u << 1,      ///< The last command is older than cmd_vel_timeout.
  kReasonRefused = 1u << 2,       ///< The last command was NaN or infinite.
  kReasonSpeedLimited = 1u << 3,  ///< max_linear_speed or max_angular_speed.
  kReasonAccelerationLimited = 1u << 4,
  kReasonJerkLimited = 1u << 5,
  kReasonNoPermit = 1u << 6,      ///< No live permit: brake.
  kReasonPermitBrake = 1u << 7,   ///< The permit orders the brake.
  kReasonPermitRamp = 1u << 8,    ///< The permit orders a ramp to standstill.
  kReasonNoState = 1u << 9,       ///< The state of this cycle was missing, held or invalid.
  kReasonBadSensors = 1u << 10,   ///< Joint samples missing or not finite: brake.
  kReasonHolding = 1u << 11,      ///< The robot stands with a zero command: the brake law holds the position.
  kReasonPermitSlow = 1u << 12,   ///< The permit's speed limit applies.
  kReasonJerkYielded = 1u << 13,  ///< The jerk limit was exceeded, so that the speed does not overshoot zero.
  kReasonStale = 1u << 14,        ///< The last message was refused for its stamp; the command before it stays in force.
  kReasonManySenders = 1u << 15,  ///< Several nodes send, one requests motion, and one_sender forbids it.
  kReasonRevoked = 1u << 16,      ///< A sender requested motion before a withdrawal and has not sent zero since.
  kReasonPartIgnored = 1u << 17,  ///< The request has a part that this machine cannot execute (CommandFrame::ignored).
};

/// The gate uses a command in at most this many ticks: at tick k one of cycles k-kCommandLife … k-1.
inline constexpr std::uint64_t kCommandLife = 4;

struct CommandFrame {
  FrameHead head;
  std::uint64_t joint_count = 0;
  std::array<JointCommand, kMaxJoints> joints{};  ///< in the order of MachineModel::joints
  std::uint64_t stop_profile = 0;                 ///< index of the profile by which the gate stops after this command
  ContactSchedule contact_schedule{};             ///< in the order of MachineModel::contacts
  Request requested;                              ///< as last received; zero once timed out or refused
  Twist twist_limited;                            ///< after limits: the target of the base
  std::uint64_t reasons = 0;                      ///< CommandReason bits, and those of the kind
  std::uint64_t state_cycle = 0;                  ///< cycle of the state that was used
  std::uint64_t permit_cycle = 0;                 ///< cycle of the permit that was used
  std::uint64_t request_cycle = 0;                ///< cycle in which the last command was received
  std::uint64_t requests_received = 0;            ///< in this run
  std::uint64_t requests_refused = 0;             ///< in this run: NaN or infinite, or counted below
  std::uint64_t requests_stale = 0;               ///< those of requests_refused with a wrong stamp
  std::uint64_t requests_crowded = 0;             ///< those of requests_refused while more than one node sent
  std::uint64_t requests_revoked = 0;  ///< those of requests_refused from revoked senders (Permit::withdrawals)
  std::uint64_t requests_partial = 0;  ///< accepted in this run with a part that this machine ignores
  std::uint64_t ignored = 0;           ///< RequestPart bits of `requested` that this machine cannot execute
  std::uint64_t timeouts = 0;          ///< in this run, one per event

  // The monitor reads the following members before it permits motion (safety/latch/motion_release.h).
  std::uint64_t first_cycle = 0;     ///< cycle of this run in which this process computed its first command
  std::uint64_t zero_requests = 0;   ///< zero velocities accepted since first_cycle without another sender's motion
  std::uint64_t zero_requested = 0;  ///< 1: since the last of these zeros no other message was received
  std::uint64_t silent_cycles = 0;   ///< since the last message of any sender, accepted or refused, or first_cycle
  std::uint64_t silence_needed = 0;  ///< cycles without a message after which no sender counts as requesting motion

  WheeledCommand wheeled;  ///< only wheeled machines fill it
  LeggedCommand legged;    ///< only machines on legs fill it
};

/// Returns whether the last message before this command was no accepted zero velocity.
inline bool requests_motion(const CommandFrame& command) noexcept {
  return command.requests_received != 0 && command.zero_requested == 0;
}

}  // namespace robot_control
