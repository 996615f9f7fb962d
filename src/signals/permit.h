#pragma once
/// The monitor sends this frame to gate and controller: the permission to move.

#include <array>
#include <cstddef>
#include <cstdint>

#include "signals/frame_head.h"
#include "signals/joint.h"

namespace robot_control {

enum class PermitAction : std::uint64_t {
  kBrake = 0,  ///< Stop category 0 of IEC 60204-1: brake now.
  kRamp = 1,   ///< Stop category 1: ramp down under supervision until `ramp_until`, then brake.
  kDrive = 2,
};

/// The value of Permit::speed_limit if nothing slows the robot down, m/s.
inline constexpr double kNoSpeedLimit = 1.0e9;

/// A permit is valid for this many cycles after its own; then it has expired.
inline constexpr std::uint64_t kPermitLife = 4;

enum class SupervisorState : std::uint64_t {
  kInit = 0,      ///< No frame of a node was received in this run, or no zero velocity was requested: unlatched brake.
  kReady = 1,     ///< The robot may drive; no motion is requested.
  kDrive = 2,     ///< The robot may drive; motion is requested or has not ended.
  kStopping = 3,  ///< The robot ramps down under supervision (category 1).
  kStopped = 4,   ///< The brake is latched until a reset is accepted.
  kFault = 5,     ///< The brake is latched, and the cause needs repair (driver fault).
};

// clang-format off
/// The numbers of the bits, in their order.
enum class StopCauseBit : unsigned {
#define CAUSE(id, ...) kBit##id,
#include "signals/stop_causes.def"
  kCount
};

/// Bits of Permit::causes, active and warnings: kCauseWheelSpeed, …; stop_causes.def has their meaning.
enum StopCause : std::uint64_t {
#define CAUSE(id, ...) kCause##id = std::uint64_t{1} << static_cast<unsigned>(StopCauseBit::kBit##id),
#include "signals/stop_causes.def"
};
// clang-format on
inline constexpr auto kStopCauses = static_cast<std::size_t>(StopCauseBit::kCount);

/// The measurement that made a cause active: `value` exceeds `limit`, in the unit of its row in stop_causes.def.
struct CauseEvidence {
  std::uint64_t cause = 0;           ///< one bit; 0: unused
  std::uint64_t cycle = 0;           ///< cycle in which it became active
  std::uint64_t joint = kMaxJoints;  ///< index into MachineModel::joints; kMaxJoints: no single joint
  double value = 0;
  double limit = 0;
};
inline constexpr std::size_t kMaxEvidence = 8;

/// Why a reset was refused; bits of Permit::reset_refusal.
enum ResetRefusal : std::uint64_t {
  kRefusalCauseActive = 1u << 0,  ///< A cause in `active` persists.
  kRefusalCommand = 1u << 1,      ///< A motion is requested, or was until a moment ago.
  kRefusalMoving = 1u << 2,       ///< A wheel still turns.
  kRefusalInit = 1u << 3,         ///< The monitor still waits.
  kRefusalSilent = 1u << 4,       ///< No sensor frame arrives, so nothing can be checked.
  kRefusalPaused = 1u << 5,       ///< The simulated machine is paused, so nothing can be checked.
  kRefusalSliding = 1u << 6,      ///< The wheels stand, but the body may still slide.
  kRefusalGap = 1u << 7,          ///< A gap (motion_release.h) alone leaves no evidence that no motion is requested.
};

/// Bits of Permit::missing, in state kInit.
enum MissingNode : std::uint64_t {
  kMissingSensors = 1,
  kMissingState = 2,
  kMissingCommand = 4,
  kMissingMachine = 8,  ///< The driver reports DriverState::kStarting.
  kMissingGate = 16,    ///< The gate has not found a permit and a command of this run yet.
};

struct Permit {
  FrameHead head;
  PermitAction action = PermitAction::kBrake;
  std::uint64_t ramp_until = 0;  ///< last cycle of the ramp; kRamp only
  std::uint64_t expiry = 0;      ///< last cycle in which this permit is valid
  SupervisorState state = SupervisorState::kInit;
  std::uint64_t causes = 0;       ///< latched since the last accepted reset
  std::uint64_t active = 0;       ///< true in this cycle
  std::uint64_t first_cause = 0;  ///< one bit: the cause that stopped the robot first
  std::uint64_t warnings = 0;     ///< causes active within the last second that warn or slow, not latched
  std::uint64_t since_cycle = 0;  ///< cycle of this run in which `state` was entered; 0 after a new run
  std::uint64_t missing = 0;      ///< nodes without a frame in this run
  std::uint64_t unreleased = 0;   ///< 1: since a start, no zero velocity was requested (safety/latch/motion_release.h)
  std::uint64_t withdrawals = 0;  ///< starts and latched causes; requests from before the last one have no effect
  std::uint64_t driver_instance = 0;  ///< SensorFrame::driver_instance of the driver for which it was issued
  std::uint64_t resets_handled = 0;   ///< counter of the last reset request that was answered
  std::uint64_t reset_refusal = 0;    ///< why that reset was refused; 0 = accepted
  double speed_limit =
      0;  ///< m/s, of the base; a wheeled machine keeps every wheel's rim below it; kNoSpeedLimit: none
  std::array<CauseEvidence, kMaxEvidence> evidence{};  ///< latched causes in the order of their time, then warnings
};

}  // namespace robot_control
