#pragma once
/// safety_monitor → gate, controller: may the robot move?

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

/// Permit::speed_limit where nothing slows the robot down; m/s.
inline constexpr double kNoSpeedLimit = 1.0e9;

/// A permit is alive for this many cycles after its own; then it has expired.
inline constexpr std::uint64_t kPermitLife = 4;

enum class SupervisorState : std::uint64_t {
  kInit = 0,      ///< A node of this run was not seen yet, or no zero velocity was requested: brake, unlatched.
  kReady = 1,     ///< Permit to drive, nothing asked.
  kDrive = 2,     ///< Permit to drive, motion asked or going on.
  kStopping = 3,  ///< Ramp under supervision (category 1).
  kStopped = 4,   ///< Latched brake; leaves by an accepted reset.
  kFault = 5,     ///< Latched brake; the cause needs repair (driver fault).
};

/// Bits of Permit::causes, active and warnings; what each means, from which fact and by which limit: safety/.
enum StopCause : std::uint64_t {
  kCauseEmergencyStopTopic = 1u << 0,
  kCauseEmergencyStopService = 1u << 1,
  kCauseEmergencyStopInput = 1u << 2,
  kCauseDriverLost = 1u << 3,  ///< No sensor frame for 20 periods (wall clock only), or the driver was restarted.
  kCauseDriverFault = 1u << 4,
  kCauseControllerLost = 1u << 5,    ///< No command for loss_cycles cycles.
  kCauseEstimatorLost = 1u << 6,     ///< No state for loss_cycles cycles.
  kCauseHeartbeatLost = 1u << 7,     ///< The operator's heartbeat stopped.
  kCauseMonitorRestarted = 1u << 8,  ///< The monitor was restarted while the driver ran on.
  kCauseCorruptFrame = 1u << 9,      ///< A checksum was wrong in three cycles in a row.
  kCauseNotFinite = 1u << 10,        ///< NaN or infinity in sensors or command, three cycles in a row.
  kCauseMonitorLate = 1u << 11,      ///< The monitor itself missed more than loss_cycles cycles.
  kCauseEncodersLost = 1u << 12,     ///< Joint samples missing or invalid.
  kCauseImuLost = 1u << 13,          ///< Gyro or accelerometer, once there, is missing.
  kCauseImuStuck = 1u << 14,         ///< Gyro or accelerometer repeats one sample while the robot moves.
  kCauseCommandStale = 1u << 15,     ///< The commands descend from an old state.
  kCauseWheelSpeed = 1u << 16,
  kCauseWheelAcceleration = 1u << 17,
  kCauseWheelEffort = 1u << 18,
  kCausePower = 1u << 19,
  kCauseStall = 1u << 20,           ///< A wheel stands although its target is not zero.
  kCauseRunaway = 1u << 21,         ///< A wheel is faster than its target.
  kCauseWrongDirection = 1u << 22,  ///< A wheel turns against its target.
  kCauseNotStopping = 1u << 23,     ///< The robot still moves although it is commanded to stand.
  kCauseYawRate = 1u << 24,         ///< Gyro and wheels disagree on how fast the robot turns.
  kCauseTilt = 1u << 25,
  kCauseTipOver = 1u << 26,  ///< Tilted, and tilting further fast.
  kCauseFreeFall = 1u << 27,
  kCauseLift = 1u << 28,  ///< The wheels carry too little of the weight.
  kCauseImpact = 1u << 29,
  kCauseGateRefuses = 1u << 30,   ///< The gate brakes in spite of the permit, or refuses frames.
  kCauseGateDisobeys = 1u << 31,  ///< The gate let a command pass in spite of the permit.
  kCauseOverruns = std::uint64_t{1} << 32,
  kCauseBatteryLow = std::uint64_t{1} << 33,
  kCauseBatteryEmpty = std::uint64_t{1} << 34,
  kCauseLatchUnreadable = std::uint64_t{1} << 35,    ///< What an earlier monitor had latched cannot be read.
  kCauseTorqueOscillation = std::uint64_t{1} << 36,  ///< A motor pulls to and fro for nothing.
};
inline constexpr std::size_t kStopCauses = 37;

/// The measurement that made a cause active: `value` beyond `limit`, in the unit of its row in cause_names.h.
struct CauseEvidence {
  std::uint64_t cause = 0;           ///< one bit; 0: unused
  std::uint64_t cycle = 0;           ///< in which it became active
  std::uint64_t joint = kMaxJoints;  ///< index into RobotModel::joints; kMaxJoints: of no single one
  double value = 0;
  double limit = 0;
};
inline constexpr std::size_t kMaxEvidence = 8;

/// Why a reset was refused; bits of Permit::reset_refusal.
enum ResetRefusal : std::uint64_t {
  kRefusalCauseActive = 1u << 0,  ///< A cause in `active` persists.
  kRefusalCommand = 1u << 1,      ///< A motion is requested, or there is no evidence that none is.
  kRefusalMoving = 1u << 2,       ///< A wheel still turns.
  kRefusalInit = 1u << 3,         ///< Still waiting for a node.
  kRefusalSilent = 1u << 4,       ///< No sensor frame comes: nothing can be judged.
  kRefusalPaused = 1u << 5,       ///< The simulated machine is paused: nothing can be judged.
  kRefusalSliding = 1u << 6,      ///< The wheels stand, but the body may still slide.
};

/// Bits of Permit::missing, in state kInit.
enum MissingNode : std::uint64_t { kMissingSensors = 1, kMissingState = 2, kMissingCommand = 4 };

struct Permit {
  FrameHead head;
  PermitAction action = PermitAction::kBrake;
  std::uint64_t ramp_until = 0;  ///< last cycle of the ramp; kRamp only
  std::uint64_t expiry = 0;      ///< last cycle in which this permit is alive
  SupervisorState state = SupervisorState::kInit;
  std::uint64_t causes = 0;       ///< latched since the last accepted reset
  std::uint64_t active = 0;       ///< true in this very cycle
  std::uint64_t first_cause = 0;  ///< one bit: what stopped the robot first
  std::uint64_t warnings = 0;     ///< active now or within the last second, reported or with a speed limit, not latched
  std::uint64_t since_cycle = 0;  ///< in which `state` was entered (of this run; 0 after a new run)
  std::uint64_t missing = 0;      ///< nodes that were not seen in this run
  std::uint64_t unreleased = 0;   ///< 1: since a start, no zero velocity was requested (safety/latch/motion_release.h)
  std::uint64_t driver_instance = 0;  ///< SensorFrame::driver_instance of the driver it was issued for
  std::uint64_t resets_handled = 0;   ///< counter of the last reset request that was answered
  std::uint64_t reset_refusal = 0;    ///< why that one was refused; 0 = accepted
  double speed_limit = 0;             ///< m/s, of every wheel's rim over the ground; kNoSpeedLimit: none
  std::array<CauseEvidence, kMaxEvidence> evidence{};  ///< latched causes in the order they came, then warnings
};

}  // namespace robot_control
