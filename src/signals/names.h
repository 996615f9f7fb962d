#pragma once
/// These tables give the name, meaning and remedy of every state, verdict and bit of the frames. Log, topics, services
/// and tests use these words only.
///
/// A table holds one row per bit in the order of the bits, which is checked below. `remedy` is empty if nothing needs
/// repair.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "signals/command_frame.h"
#include "signals/gate_report.h"
#include "signals/injected_fault.h"
#include "signals/permit.h"
#include "signals/robot_kinds.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

/// A BitName describes one bit of a frame's bit set in words.
struct BitName {
  std::uint64_t bit;
  std::string_view name;      ///< snake_case, for logs and topics
  std::string_view sentence;  ///< the condition that the bit reports
  std::string_view remedy;    ///< the action that removes the condition
  std::string_view actor =
      {};  ///< role that applies the remedy: "operator", "integrator", "technician"; stop causes only
  std::string_view unit = {};  ///< unit of CauseEvidence::value and limit; empty: the cause has none
};

// clang-format off
/// A latched cause needs e_stop_reset after its remedy; with an empty remedy it needs only that. The actor is
///   operator     drives the robot
///   integrator   sets the robot up: nodes, parameters, URDF, network
///   technician   repairs the machine: sensors, motors, cables, battery
inline constexpr auto kStopCauseNames = std::to_array<BitName>({
#define CAUSE(id, name, sentence, remedy, actor, unit, ...) {kCause##id, #name, sentence, remedy, actor, unit},
#include "signals/stop_causes.def"
});

inline constexpr auto kResetRefusalNames = std::to_array<BitName>({
    {kRefusalCauseActive, "cause_active", "a cause of the stop persists", "remove the cause"},
    {kRefusalCommand, "command", "a motion is still being requested, or it is not certain yet that none is",
     "stop the sender on {request} and wait for {request_timeout}, or let it send zero"},
    {kRefusalMoving, "moving", "the robot has not come to rest", "wait until every joint stands"},
    {kRefusalInit, "init", "the monitor still waits", "read in safety_status what is missing"},
    {kRefusalSilent, "silent", "no sensor frame comes", "look whether {driver} runs, then ask again"},
    {kRefusalPaused, "paused", "the simulation is paused", "let it run ({driver}/set_pause), then ask again"},
    {kRefusalSliding, "sliding", "the wheels stand, but the robot may still slide",
     "ask again: from speed v it is assumed to stand after v/stop_deceleration"},
});

inline constexpr auto kMissingNodeNames = std::to_array<BitName>({
    {kMissingSensors, "sensors", "no sensors of this run were seen", "start the driver"},
    {kMissingState, "state", "no state of this run was seen", "start {estimator}"},
    {kMissingCommand, "command", "no command of this run was seen", "start {controller}"},
    {kMissingMachine, "machine", "the machine is starting", "read in /diagnostics what its driver waits for"},
    {kMissingGate, "gate", "the driver does not read permits and commands yet", "wait 0.1 s; if it stays, look whether {driver} gets its core"},
});

inline constexpr auto kGateReasonNames = std::to_array<BitName>({
    {kGateFirstTick, "first_tick", "the first tick of a run brakes", ""},
    {kGateNoPermit, "no_permit", "there is no permit of this run from the last 7 cycles",
     "look whether {monitor} runs and gets its core"},
    {kGatePermitExpired, "permit_expired", "the newest permit has expired",
     "look whether {monitor} runs and gets its core"},
    {kGatePermitBrake, "permit_brake", "the permit orders the brake", "read the cause in safety_status"},
    {kGateRampOver, "ramp_over", "the ramp's last cycle has passed", "read the cause in safety_status"},
    {kGateNoCommand, "no_command", "there is no command of the last 4 cycles",
     "look whether {controller} runs and gets its core"},
    {kGateCommandHeld, "command_held", "the command is older than one cycle and is held", ""},
    {kGateNotFinite, "not_finite", "the command holds NaN or infinity", "look at the controller's log"},
    {kGateChecksum, "checksum", "a frame's checksum is wrong", "look for two builds on one bus or failing memory"},
    {kGateFuture, "future", "a frame of this or a later cycle was refused", "look for two drivers on one bus"},
    {kGateEffortClamped, "effort_clamped", "an effort was clamped to its joint's limit", ""},
    {kGateWrongJointCount, "wrong_joint_count", "the command is for another number of joints",
     "start every node with the same robot"},
    {kGateControllerBrake, "controller_brake", "the controller asks the brake of every joint", ""},
    {kGateUnknownMode, "unknown_mode", "a joint mode, a stop profile or a permit action is unknown",
     "look for two builds on one bus"},
    {kGateRampTooLong, "ramp_too_long", "ramp permits have lasted longer than any ramp may",
     "read the cause in safety_status"},
    {kGateRateClamped, "rate_clamped", "an effort, or a drive's velocity, changed faster than its joint can", ""},
    {kGateSpeedClamped, "speed_clamped", "a joint is near or above its speed limit", ""},
    {kGatePositionClamped, "position_clamped", "a joint is near or at an end stop", ""},
    {kGateBadSensors, "bad_sensors", "joint samples are missing or not finite", "look at the driver's faults"},
});

inline constexpr auto kCommandReasonNames = std::to_array<BitName>({
    {kReasonNoCommand, "no_command", "nothing was received on {request} in this run", "publish on {request}"},
    {kReasonTimedOut, "timed_out", "the last {request} is older than {request_timeout}",
     "publish on {request} more often than every {request_timeout}"},
    {kReasonRefused, "refused", "the last {request} was NaN or infinite", "repair the sender on {request}"},
    {kReasonSpeedLimited, "speed_limited", "the requested speed is above max_linear_speed, max_angular_speed or, on legs, "
     "max_lateral_speed", ""},
    {kReasonAccelerationLimited, "acceleration_limited", "the acceleration limit shapes the motion", ""},
    {kReasonJerkLimited, "jerk_limited", "the jerk limit shapes the motion", ""},
    {kReasonNoPermit, "no_permit", "there is no live permit", "start {monitor}"},
    {kReasonPermitBrake, "permit_brake", "the permit orders the brake", "read the cause in safety_status"},
    {kReasonPermitRamp, "permit_ramp", "the permit orders a ramp to standstill", "read the cause in safety_status"},
    {kReasonNoState, "no_state", "the state of this cycle is missing, held or invalid", "start {estimator}"},
    {kReasonBadSensors, "bad_sensors", "joint samples are missing or not finite", "look at the driver's faults"},
    {kReasonHolding, "holding", "standing with zero command: the brake holds the position", ""},
    {kReasonPermitSlow, "permit_slow", "the safety monitor limits the speed", "read the warning in safety_status"},
    {kReasonJerkYielded, "jerk_yielded", "it stopped at zero with more jerk than the limit, rather than beyond", ""},
    {kReasonStale, "stale", "the last message was older by its stamp than {request_timeout}, or of the future",
     "synchronise the sender's clock with the robot's, or send without a stamp: the age then counts from the arrival"},
    {kReasonManySenders, "many_senders", "more than one node sends commands, which one_sender forbids",
     "stop all but one"},
    {kReasonRevoked, "revoked",
     "a sender goes on requesting motion that was requested before a stop, a restart or a pause, or meanwhile",
     "let it send zero, or restart it"},
    {kReasonPartIgnored, "part_ignored", "a part of the request is ignored, because this robot cannot execute it",
     "request only what this robot can do; a differential drive takes linear.x and angular.z, a robot on legs linear.y, too"},
    {kReasonCurvatureKept, "curvature_kept", "one axis was scaled to keep the commanded curvature", ""},
    {kReasonSaturated, "saturated", "a wheel's torque or speed is at its limit", ""},
    {kReasonOutOfReach, "out_of_reach", "the requested pose is beyond the ranges of the legs: the body stops before it",
     "request a pose within the ranges of docs/legs.md"},
    {kReasonNotStanding, "not_standing", "a pose or a foot is requested, and the robot does not stand",
     "call set_posture with 'standing'"},
    {kReasonNotLying, "not_lying", "positions of joints are requested, and the robot does not lie",
     "call set_posture with 'lying'"},
    {kReasonLegSpeed, "leg_speed", "the legs do not carry the body faster, by the speed limits of their joints or their "
     "reach", "request less speed"},
    {kReasonNoPlan, "no_plan", "the forces of the feet have no solution: the last ones are in force for up to three plans, "
     "then the robot stands", "look for a jump of odom, and compare mass and inertia of the URDF with the robot"},
    {kReasonTooSteep, "too_steep", "the ground slopes more than robots on legs stand up on",
     "set the robot down where the ground slopes less; on such ground, look at the IMU"},
});

inline constexpr auto kRequestPartNames = std::to_array<BitName>({
    {kPartLinearX, "linear.x", "", ""},
    {kPartLinearY, "linear.y", "", ""},
    {kPartLinearZ, "linear.z", "", ""},
    {kPartAngularX, "angular.x", "", ""},
    {kPartAngularY, "angular.y", "", ""},
    {kPartAngularZ, "angular.z", "", ""},
    {kPartHeight, "posture.height", "", ""},
    {kPartRoll, "posture.roll", "", ""},
    {kPartPitch, "posture.pitch", "", ""},
    {kPartMode, "mode", "", ""},
    {kPartX, "posture.x", "", ""},
    {kPartY, "posture.y", "", ""},
    {kPartYaw, "posture.yaw", "", ""},
    {kPartJoints, "joints", "", ""},
});

inline constexpr auto kDriverFaultNames = std::to_array<BitName>({
    {kFaultSimulationDiverged, "simulation_diverged", "the physics engine warned of NaN or huge values",
     "reset the plant; look at the scene and the commands"},
    {kFaultSimulationError, "simulation_error", "the physics engine raised an error",
     "restart the plant; look at its log"},
    {kFaultNotFinite, "not_finite", "the driver read NaN or infinity", "look at the sensors' cables and drives"},
    {kFaultLink, "link", "the device does not answer", "look at cable and power"},
    {kFaultDrive, "drive", "a motor drive reports a fault", "read the drive's own error and clear it"},
});

inline constexpr auto kStateFlagNames = std::to_array<BitName>({
    {kStateValid, "valid", "pose and twist may be used", ""},
    {kStateSlip, "slip", "wheels and inertial sensors disagree", ""},
    {kStateStandstill, "standstill", "wheels and gyro are quiet", ""},
    {kStateRestarted, "restarted", "the estimator continues an earlier process's state", ""},
    {kStateSkipped, "skipped", "a cycle of sensors was never seen", "look whether {estimator} gets its core"},
    {kStateNoGyro, "no_gyro", "yaw comes from the wheels alone", "look at the IMU"},
    {kStateBadSample, "bad_sample", "a sample was missing, not finite or impossible and was not used",
     "look at the driver's faults"},
    {kStateNoLeftEncoder, "no_left_encoder", "no valid readings of the left encoders", "look at the left encoder"},
    {kStateNoRightEncoder, "no_right_encoder", "no valid readings of the right encoders", "look at the right encoder"},
    {kStateNoAccelerometer, "no_accelerometer", "tilt, and slip of all wheels together, are not noticed",
     "look at the IMU"},
    {kStateDegraded, "degraded", "the pose is less certain than usual: slip, or no gyro bias yet",
     "read the reason in degraded"},
    {kStateEncoderRestarted, "encoder_restarted", "an encoder began again; the travel since its last reading is lost",
     "look at the encoders' cables and power"},
});

inline constexpr auto kDegradedReasonNames = std::to_array<BitName>({
    {kDegradedPosition, "position", "wheels or feet contradict the IMU, as in a slip: the speed is that of one of them alone",
     "look at the ground and at the IMU's mounting; wheels of a robot that shakes: slip_detection false"},
    {kDegradedHeading, "heading", "no rest has shown the gyro's bias yet, or wheels and gyro contradict each other",
     "let the robot rest for a second"},
});

inline constexpr auto kSlipReasonNames = std::to_array<BitName>({
    {kSlipLeft, "left", "the left wheels do not roll", ""},
    {kSlipRight, "right", "the right wheels do not roll", ""},
    {kSlipSpinning, "spinning", "a wheel turns faster than the ground passes", "accelerate less"},
    {kSlipStalled, "stalled", "a wheel turns slower than the ground passes", "brake less"},
    {kSlipTurn, "turn", "the wheels' yaw rate contradicts the gyro", ""},
    {kSlipSideways, "sideways", "the robot slides sideways", "turn less fast"},
});

/// The names are in the order of SensorIndex.
inline constexpr std::array<std::string_view, kWheeledSensors> kStateSensorNames{"left_encoder",  "right_encoder",   "gyro",
                                                                   "accelerometer", "lateral_contact", "vertical_contact"};

inline constexpr auto kDigitalInputNames = std::to_array<BitName>({
    {kInputEmergencyStop, "e_stop", "the emergency stop button is pressed", "release the button"},
});
// clang-format on

constexpr std::string_view name_of(SupervisorState state) noexcept {
  constexpr std::array<std::string_view, 6> kNames{"INIT", "READY", "DRIVE", "STOPPING", "STOPPED", "FAULT"};
  const auto index = static_cast<std::size_t>(state);
  return index < kNames.size() ? kNames[index] : "UNKNOWN";
}

constexpr std::string_view name_of(PermitAction action) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"brake", "ramp", "drive"};
  const auto index = static_cast<std::size_t>(action);
  return index < kNames.size() ? kNames[index] : "unknown";
}

constexpr std::string_view name_of(GateVerdict verdict) noexcept {
  constexpr std::array<std::string_view, 5> kNames{"brake", "passed", "held", "clamped", "ramp"};
  const auto index = static_cast<std::size_t>(verdict);
  return index < kNames.size() ? kNames[index] : "unknown";
}

constexpr std::string_view name_of(DriverState state) noexcept {
  constexpr std::array<std::string_view, 5> kNames{"starting", "running", "paused", "fault", "ended"};
  const auto index = static_cast<std::size_t>(state);
  return index < kNames.size() ? kNames[index] : "unknown";
}

constexpr std::string_view name_of(LinkState state) noexcept {
  constexpr std::array<std::string_view, 4> kNames{"starting", "up", "degraded", "down"};
  const auto index = static_cast<std::size_t>(state);
  return index < kNames.size() ? kNames[index] : "unknown";
}

constexpr std::string_view name_of(LegPhase phase) noexcept {
  constexpr std::array<std::string_view, 7> kNames{"lying",    "gathering", "rising", "standing",
                                                   "lowering", "joints",    "walking"};
  const auto index = static_cast<std::size_t>(phase);
  return index < kNames.size() ? kNames[index] : "unknown";
}

constexpr std::string_view name_of(JointMode mode) noexcept {
  constexpr std::array<std::string_view, kJointModes> kNames{"brake", "effort", "velocity", "impedance",
                                                             "drive_velocity"};
  const auto index = static_cast<std::size_t>(mode);
  return index < kNames.size() ? kNames[index] : "unknown";
}

/// The words of the service inject_fault (machine/fault_names.h), in the order of FaultComponent and of FaultKind.
inline constexpr std::array<std::string_view, kFaultComponents> kFaultComponentNames{
    "encoder", "motor", "gyro", "accelerometer", "battery", "e_stop_button", "controller", "estimator", "monitor"};
inline constexpr std::array<std::string_view, kFaultKinds> kFaultKindNames{"ok",    "off",  "stuck",   "garbage",
                                                                           "wrong", "slow", "delayed", "intermittent"};

constexpr std::string_view name_of(FaultComponent component) noexcept {
  const auto index = static_cast<std::size_t>(component);
  return index < kFaultComponentNames.size() ? kFaultComponentNames[index] : "unknown";
}

constexpr std::string_view name_of(FaultKind kind) noexcept {
  const auto index = static_cast<std::size_t>(kind);
  return index < kFaultKindNames.size() ? kFaultKindNames[index] : "unknown";
}

/// Returns the index of a word; nothing if it is not in the list.
constexpr std::optional<std::size_t> index_of(std::span<const std::string_view> words, std::string_view word) noexcept {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == word) return i;
  }
  return std::nullopt;
}

/// Returns the row of one bit; null if it is not in the table.
constexpr const BitName* row_of(std::span<const BitName> table, std::uint64_t bit) noexcept {
  for (const BitName& row : table) {
    if (row.bit == bit) return &row;
  }
  return nullptr;
}

/// Returns the names of all bits that are set, lowest first: "controller_lost heartbeat_lost". It allocates and is not
/// meant for the loop.
inline std::string names_of(std::span<const BitName> table, std::uint64_t bits, std::string_view separator = " ") {
  std::string text;
  for (const BitName& row : table) {
    if ((bits & row.bit) == 0) continue;
    if (!text.empty()) text += separator;
    text += row.name;
  }
  return text;
}

/// Returns "the emergency stop button is pressed (release the button); …" for a robot with these programs. Allocates.
inline std::string sentences_of(std::span<const BitName> table, std::uint64_t bits, const Programs& programs) {
  std::string text;
  for (const BitName& row : table) {
    if ((bits & row.bit) == 0) continue;
    if (!text.empty()) text += "; ";
    text += with_programs(row.sentence, programs);
    if (!row.remedy.empty()) text.append(" (").append(with_programs(row.remedy, programs)).append(")");
  }
  return text;
}

/// Returns whether row i of the table names bit i.
constexpr bool in_bit_order(std::span<const BitName> table) noexcept {
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].bit != std::uint64_t{1} << i) return false;
  }
  return true;
}
static_assert(in_bit_order(kStopCauseNames) && kStopCauseNames.size() == kStopCauses);
static_assert(in_bit_order(kResetRefusalNames) && in_bit_order(kMissingNodeNames));
static_assert(in_bit_order(kGateReasonNames) && in_bit_order(kCommandReasonNames) && in_bit_order(kRequestPartNames));
static_assert(in_bit_order(kDriverFaultNames) && in_bit_order(kStateFlagNames) && in_bit_order(kSlipReasonNames) &&
              in_bit_order(kDegradedReasonNames) && in_bit_order(kDigitalInputNames));

}  // namespace robot_control
