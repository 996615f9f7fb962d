#pragma once
/// A GateReport holds the gate's decision in one tick.

#include <cstdint>

#include "signals/contact.h"

namespace robot_control {

enum class GateVerdict : std::uint64_t {
  kBrake = 0,    ///< The driver's brake law acts on every joint.
  kPassed = 1,   ///< The command of cycle k-1, unchanged.
  kHeld = 2,     ///< An older command (k-2 … k-4), unchanged.
  kClamped = 3,  ///< Passed or held, with at least one number clamped.
  kRamp = 4,     ///< Passed under a ramp permit (stop category 1), clamped where needed.
};

/// Why a verdict is not kPassed; bits of GateReport::reasons.
enum GateReason : std::uint64_t {
  kGateFirstTick = 1u << 0,         ///< Tick 0 of a run.
  kGateNoPermit = 1u << 1,          ///< No permit of this run in the last 7 cycles.
  kGatePermitExpired = 1u << 2,     ///< The newest permit expired: the monitor made no progress.
  kGatePermitBrake = 1u << 3,       ///< The permit orders the brake.
  kGateRampOver = 1u << 4,          ///< The ramp's last cycle has passed.
  kGateNoCommand = 1u << 5,         ///< No command of cycles k-4 … k-1.
  kGateCommandHeld = 1u << 6,       ///< The command is older than k-1.
  kGateNotFinite = 1u << 7,         ///< NaN or infinity in the command.
  kGateChecksum = 1u << 8,          ///< The checksum of command or permit is wrong.
  kGateFuture = 1u << 9,            ///< A frame of cycle >= k was refused.
  kGateEffortClamped = 1u << 10,    ///< |effort| above the joint's limit.
  kGateWrongJointCount = 1u << 11,  ///< The command is for another number of joints.
  kGateControllerBrake = 1u << 12,  ///< The command itself requests the brake of every joint.
  kGateUnknownMode = 1u << 13,      ///< A mode, a stop profile or a permit action that does not exist.
  kGateRampTooLong = 1u << 14,      ///< Ramp permits have lasted longer than any ramp may.
  kGateRateClamped = 1u << 15,      ///< The effort, or the velocity for a drive's own loop, changed too fast.
  kGateSpeedClamped = 1u << 16,     ///< Effort towards more speed, or a target speed, near or above the speed limit.
  kGatePositionClamped = 1u << 17,  ///< The joint is near or at an end stop.
  kGateBadSensors = 1u << 18,       ///< Joint samples that the clamps need are missing or not finite.
};

struct GateReport {
  std::uint64_t cycle = 0;  ///< k, of the tick.
  GateVerdict verdict = GateVerdict::kBrake;
  std::uint64_t reasons = kGateFirstTick;
  std::uint64_t command_cycle = 0;  ///< Cycle of the last command that was found in this run, used or not; 0: none.
  std::uint64_t permit_cycle = 0;   ///< Cycle of the permit that was used; meaningless if none was.
  std::uint64_t held = 0;           ///< Ticks of this run with a held command.
  std::uint64_t missed = 0;         ///< Ticks of this run that braked because no command was available, except tick 0.
  std::uint64_t late_permits = 0;   ///< Ticks of this run whose permit was older than k-1, except tick 0.
  std::uint64_t refused = 0;        ///< Frames refused in this run for checksum, future, count, finiteness or mode.
  ContactSchedule contact_schedule{};  ///< That of the command which this tick executed; 0 where it braked.
};

}  // namespace robot_control
