#pragma once
/// Nothing moves without a release: each seed gives one random sequence in virtual time. Nodes die, restart, stall,
/// pause and reset. Two senders of commands have clocks that jump; they are suspended, restarted, and close and open
/// their connections. Publishers of e_stop come and go; cmd_vel_timeouts change; emergency stops and resets are
/// requested. A restart builds the node's classes again on the channels of their predecessors, with an empty inbox. In
/// a third of the sequences the senders are two sources of a list with a lock, whose timeouts are short, long or none.
/// A robot on legs has three processes. One sends twists and poses, one sends poses, and one sends twists, poses, feet
/// and joints over one connection. set_posture and set_gait are called. Its request_timeout is 0, 0.05 or 1.25 s.
///
/// The judge knows only what was sent, which stamps were refused, and what was started. With T = the shorter of
/// cmd_vel_timeout and the one before it, in cycles:
///   motion      the machine is commanded anything but the brake only if, since the last start of a node (or reset of
///               the run), a zero velocity was sent while no other sender requested motion, or nothing was sent for T.
///               The start of an estimator or a controller counts from its first frame of the newest cycle
///   stop        … and only if no emergency stop was requested since the last accepted reset
///   requested   … and only while some sender requests motion that owes no zero velocity: a sender owes one from a
///               start, a pause or a stop that finds it requesting motion, or having done so within T of when the
///               controller learns of it, and from a
///               release that finds it requesting motion, to its own next accepted zero, over all its connections and
///               all controllers of a run or of a stop
///   owner       … and on legs only what one process, or one call of set_posture, has stated since the last withdrawal
///               and within two timeouts: every part of the request in force is of that process, and its gait is that
///               of the request, or was chosen since then
///   lies        a robot on legs that the gate has stopped for 1.5 s lies upright, and stays where it is
///   reset       is accepted only if no sender's newest message of the last T, to this controller, requested motion
///               or was refused, and if no publisher's last word on e_stop was true, as far as this monitor or an
///               earlier one received it; that of one that has left counts until the first message of another
///               publisher says false

#include <cstdint>
#include <optional>
#include <string>

#include "machine/wheeled/drive_train_parameters.h"

namespace robot_control {

inline constexpr int kReleaseCycles = 2000;

/// Figures of a sequence; a sequence without any motion proves nothing.
struct ReleaseFigures {
  std::uint64_t moving_cycles = 0;
  std::uint64_t accepted_resets = 0;
  std::uint64_t starts = 0;
  std::uint64_t standing_cycles = 0;  ///< of a robot on legs
  std::uint64_t lying_cycles = 0;     ///< after a stop, in which it was judged
};

/// The rule that `seed` violates with drives of this command, and its cycle; none if all hold. Adds to `figures`.
std::optional<std::string> release_violation(std::uint64_t seed, ReleaseFigures& figures,
                                             WheelCommand drives = WheelCommand::kTorque);

/// The same of quadbot on the simulated machine, which walks before anything happens.
std::optional<std::string> walking_release_violation(std::uint64_t seed, ReleaseFigures& figures);

}  // namespace robot_control
