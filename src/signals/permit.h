#pragma once
/// safety_monitor → gate, controller: may the robot move?

#include <cstdint>

#include "signals/frame_head.h"

namespace robot_control {

enum class PermitAction : std::uint64_t {
  kBrake = 0,  ///< Stop category 0 of IEC 60204-1: brake now.
  kRamp = 1,   ///< Stop category 1: ramp down under supervision until `ramp_until`, then brake.
  kDrive = 2,
};

/// A permit is alive for this many cycles after its own; then it has expired.
inline constexpr std::uint64_t kPermitLife = 4;

enum class SupervisorState : std::uint64_t {
  kInit = 0,      ///< Sensors, state and command of this run were not all seen yet: brake, unlatched.
  kReady = 1,     ///< Permit to drive, nothing asked.
  kDrive = 2,     ///< Permit to drive, motion asked or going on.
  kStopping = 3,  ///< Ramp under supervision (category 1).
  kStopped = 4,   ///< Latched brake; leaves by an accepted reset.
  kFault = 5,     ///< Latched brake whose cause needs a repair (driver fault).
};

/// Bits of Permit::causes.
enum StopCause : std::uint64_t {
  kCauseEmergencyStopTopic = 1u << 0,
  kCauseEmergencyStopService = 1u << 1,
  kCauseEmergencyStopInput = 1u << 2,
  kCauseDriverLost = 1u << 3,  ///< No sensor frame for 20 periods (wall clock only).
  kCauseDriverFault = 1u << 4,
  kCauseControllerLost = 1u << 5,    ///< No command for loss_cycles cycles.
  kCauseEstimatorLost = 1u << 6,     ///< No state for loss_cycles cycles.
  kCauseHeartbeatLost = 1u << 7,     ///< The operator's heartbeat stopped.
  kCauseMonitorRestarted = 1u << 8,  ///< The monitor was restarted while the driver ran on.
  kCauseCorruptFrame = 1u << 9,      ///< A checksum was wrong in three cycles in a row.
  kCauseNotFinite = 1u << 10,        ///< NaN or infinity in sensors or command, three cycles in a row.
  kCauseMonitorLate = 1u << 11,      ///< The monitor itself missed more than loss_cycles cycles.
};

/// Why a reset was refused; bits of Permit::reset_refusal.
enum ResetRefusal : std::uint64_t {
  kRefusalCauseActive = 1u << 0,  ///< A cause in `active` persists.
  kRefusalCommand = 1u << 1,      ///< A motion is still being asked for.
  kRefusalMoving = 1u << 2,       ///< A wheel still turns.
  kRefusalInit = 1u << 3,         ///< Still waiting for a node.
  kRefusalSilent = 1u << 4,       ///< No sensor frame comes: nothing can be judged.
  kRefusalPaused = 1u << 5,       ///< The simulated machine is paused: nothing can be judged.
};

/// Bits of Permit::missing, in state kInit.
enum MissingNode : std::uint64_t { kMissingSensors = 1, kMissingState = 2, kMissingCommand = 4 };

struct Permit {
  FrameHead head;
  PermitAction action = PermitAction::kBrake;
  std::uint64_t ramp_until = 0;  ///< last cycle of the ramp; kRamp only
  std::uint64_t expiry = 0;      ///< last cycle in which this permit is alive
  SupervisorState state = SupervisorState::kInit;
  std::uint64_t causes = 0;          ///< latched since the last accepted reset
  std::uint64_t active = 0;          ///< true in this very cycle
  std::uint64_t first_cause = 0;     ///< one bit: what stopped the robot first
  std::uint64_t since_cycle = 0;     ///< in which `state` was entered (of this run; 0 after a new run)
  std::uint64_t missing = 0;         ///< who has not been seen in this run
  std::uint64_t boot = 0;            ///< SensorFrame::boot of the driver it was issued for
  std::uint64_t resets_handled = 0;  ///< counter of the last reset request that was answered
  std::uint64_t reset_refusal = 0;   ///< why that one was refused; 0 = accepted
};

}  // namespace robot_control
