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
    {kRefusalCauseActive, "cause_active", "a cause of the stop persists", "remove this cause first"},
    {kRefusalCommand, "command", "motion is still requested, or was until a moment ago",
     "stop publishing on {request} for {request_timeout}, or publish zero"},
    {kRefusalMoving, "moving", "the robot still moves", "wait until every joint stands still"},
    {kRefusalInit, "init", "the safety monitor is still starting", "check safety_status for what is missing"},
    {kRefusalSilent, "silent", "no sensor data arrives", "check that {driver} runs, then call e_stop_reset again"},
    {kRefusalPaused, "paused", "the simulation is paused", "resume it ({driver}/set_pause false), then call e_stop_reset again"},
    {kRefusalSliding, "sliding", "the wheels stand still, but the robot may still slide",
     "wait, then call e_stop_reset again: from speed v, it is assumed to stand after v/stop_deceleration"},
    {kRefusalGap, "gap", "the loop started or missed cycles a moment ago: nothing shows yet that no motion is requested",
     "call e_stop_reset again after {request_timeout}; if this persists, check that {controller} gets enough CPU time (scripts/doctor.py)"},
});

inline constexpr auto kMissingNodeNames = std::to_array<BitName>({
    {kMissingSensors, "sensors", "no sensor data of this run yet", "start {driver}"},
    {kMissingState, "state", "no state of this run yet", "start {estimator}"},
    {kMissingCommand, "command", "no command of this run yet", "start {controller}"},
    {kMissingMachine, "machine", "the hardware is starting", "check in /diagnostics what {driver} waits for"},
    {kMissingGate, "gate", "the driver does not read permits and commands yet", "wait 0.1 s; if this persists, check that {driver} gets enough CPU time (scripts/doctor.py)"},
});

inline constexpr auto kGateReasonNames = std::to_array<BitName>({
    {kGateFirstTick, "first_tick", "the first tick of a run brakes", ""},
    {kGateNoPermit, "no_permit", "there is no permit of this run from the last 7 cycles",
     "check that {monitor} runs and gets enough CPU time (scripts/doctor.py)"},
    {kGatePermitExpired, "permit_expired", "the newest permit has expired",
     "check that {monitor} runs and gets enough CPU time (scripts/doctor.py)"},
    {kGatePermitBrake, "permit_brake", "the permit orders the brake", "check the cause in safety_status"},
    {kGateRampOver, "ramp_over", "the permitted time of the ramp is over", "check the cause in safety_status"},
    {kGateNoCommand, "no_command", "there is no command from the last 4 cycles",
     "check that {controller} runs and gets enough CPU time (scripts/doctor.py)"},
    {kGateCommandHeld, "command_held", "the command is older than one cycle and is held", ""},
    {kGateNotFinite, "not_finite", "the command contains NaN or infinity", "check the log of {controller}"},
    {kGateChecksum, "checksum", "a frame's checksum is wrong", "check that all nodes are of one build, then the memory (memtest86+)"},
    {kGateFuture, "future", "a frame of this or a later cycle was refused", "check that one driver runs on this bus"},
    {kGateEffortClamped, "effort_clamped", "an effort was clamped to its joint's limit", ""},
    {kGateWrongJointCount, "wrong_joint_count", "the command is for another number of joints",
     "restart all nodes with the same robot"},
    {kGateControllerBrake, "controller_brake", "the controller brakes every joint", ""},
    {kGateUnknownMode, "unknown_mode", "a joint mode, a stop profile or a permit action is unknown",
     "check that all nodes are of one build"},
    {kGateRampTooLong, "ramp_too_long", "the ramp has lasted longer than allowed",
     "check the cause in safety_status"},
    {kGateRateClamped, "rate_clamped", "an effort, or a drive's velocity, changed faster than its joint can", ""},
    {kGateSpeedClamped, "speed_clamped", "a joint is near or above its speed limit", ""},
    {kGatePositionClamped, "position_clamped", "a joint is near or at an end stop", ""},
    {kGateBadSensors, "bad_sensors", "joint samples are missing or not finite", "check the faults of {driver} in /diagnostics"},
});

inline constexpr auto kCommandReasonNames = std::to_array<BitName>({
    {kReasonNoCommand, "no_command", "nothing was received on {request} in this run", "publish on {request}"},
    {kReasonTimedOut, "timed_out", "the last {request} is older than {request_timeout}",
     "publish on {request} more often than every {request_timeout}"},
    {kReasonRefused, "refused", "the last {request} contained NaN or infinity", "check the node that publishes {request}"},
    {kReasonSpeedLimited, "speed_limited", "the requested speed is above max_linear_speed, max_angular_speed or, on legs, "
     "max_lateral_speed", ""},
    {kReasonAccelerationLimited, "acceleration_limited", "the acceleration limit shapes the motion", ""},
    {kReasonJerkLimited, "jerk_limited", "the jerk limit shapes the motion", ""},
    {kReasonNoPermit, "no_permit", "there is no valid permit", "start {monitor}"},
    {kReasonPermitBrake, "permit_brake", "the permit orders the brake", "check the cause in safety_status"},
    {kReasonPermitRamp, "permit_ramp", "the permit orders a ramp to standstill", "check the cause in safety_status"},
    {kReasonNoState, "no_state", "the state of this cycle is missing, held or invalid", "start {estimator}"},
    {kReasonBadSensors, "bad_sensors", "joint samples are missing or not finite", "check the faults of {driver} in /diagnostics"},
    {kReasonHolding, "holding", "the command is zero: the brake holds the position", ""},
    {kReasonPermitSlow, "permit_slow", "the safety monitor limits the speed", "check the warning in safety_status"},
    {kReasonJerkYielded, "jerk_yielded", "the jerk limit was exceeded to stop exactly at zero", ""},
    {kReasonStale, "stale", "the last message's time stamp is older than {request_timeout} or lies in the future",
     "check the sender's clock (chrony), or publish without a stamp: the age then counts from the arrival"},
    {kReasonManySenders, "many_senders", "more than one node sends commands (one_sender: true)",
     "stop all senders but one"},
    {kReasonRevoked, "revoked",
     "a node must send zero velocity once before its commands are accepted again (after a stop, restart or pause)",
     "publish zero from this node, or restart it"},
    {kReasonPartIgnored, "part_ignored", "a part of the request is ignored, because this robot cannot execute it",
     "request only what this robot can do: linear.x and angular.z, on legs also linear.y"},
    {kReasonCurvatureKept, "curvature_kept", "one axis was scaled to keep the commanded curvature", ""},
    {kReasonSaturated, "saturated", "a wheel's torque or speed is at its limit", ""},
    {kReasonOutOfReach, "out_of_reach", "the requested pose is beyond the ranges of the legs: the body stops before it",
     "request a pose within the ranges in docs/legs.md"},
    {kReasonNotStanding, "not_standing", "a pose or a foot position is requested, but the robot does not stand",
     "call set_posture with 'standing'"},
    {kReasonNotLying, "not_lying", "joint positions are requested, but the robot does not lie",
     "call set_posture with 'lying'"},
    {kReasonLegSpeed, "leg_speed", "the joint speed limits or the reach of the legs limit the speed", "reduce the requested speed"},
    {kReasonNoPlan, "no_plan", "no solution for the foot forces: the last forces stay in force for up to three plans, then the robot stands",
     "check odom for a jump, then mass and inertia in the URDF"},
    {kReasonTooSteep, "too_steep", "the slope of the ground is too steep to stand up",
     "set the robot on flatter ground; if the ground is flat, check the IMU"},
    {kReasonMetRiser, "met_riser", "a foot hit an obstacle, and is lifted over it", ""},
    {kReasonReaching, "reaching", "a foot finds no ground where it was to land, and goes farther down", ""},
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
     "reset the simulation ({driver}/reset), then check the scene and the commands"},
    {kFaultSimulationError, "simulation_error", "the physics engine raised an error",
     "restart {driver}, then check its log"},
    {kFaultNotFinite, "not_finite", "the driver read NaN or infinity", "check cables and drives of the sensors"},
    {kFaultLink, "link", "the device does not answer", "check cable and power"},
    {kFaultDrive, "drive", "a motor drive reports a fault", "check the drive's own error in /diagnostics, then reset the drive"},
});

inline constexpr auto kStateFlagNames = std::to_array<BitName>({
    {kStateValid, "valid", "pose and twist may be used", ""},
    {kStateSlip, "slip", "wheels and inertial sensors disagree", ""},
    {kStateStandstill, "standstill", "wheels and gyro are at rest", ""},
    {kStateRestarted, "restarted", "the estimator continues an earlier process's state", ""},
    {kStateSkipped, "skipped", "the sensor data of a cycle was missed", "check that {estimator} gets enough CPU time (scripts/doctor.py)"},
    {kStateNoGyro, "no_gyro", "yaw is computed from the wheels only", "check the IMU"},
    {kStateBadSample, "bad_sample", "a sample was missing, not finite or impossible and was not used",
     "check the faults of {driver} in /diagnostics"},
    {kStateNoLeftEncoder, "no_left_encoder", "no valid readings of the left encoders", "check the left encoder"},
    {kStateNoRightEncoder, "no_right_encoder", "no valid readings of the right encoders", "check the right encoder"},
    {kStateNoAccelerometer, "no_accelerometer", "tilt, and slip of all wheels together, are not detected",
     "check the IMU"},
    {kStateDegraded, "degraded", "the pose is less certain than usual: slip, or no gyro bias yet",
     "check the reason in degraded"},
    {kStateEncoderRestarted, "encoder_restarted", "an encoder restarted; the travel since its last reading is lost",
     "check the cables and the power of the encoders"},
});

inline constexpr auto kDegradedReasonNames = std::to_array<BitName>({
    {kDegradedPosition, "position", "wheels or feet contradict the IMU, as in a slip: only one of them gives the speed",
     "check the ground and the mounting of the IMU; on wheels, if the robot vibrates, set slip_detection: false"},
    {kDegradedHeading, "heading", "the gyro's bias is not known yet, or wheels and gyro contradict each other",
     "stop the robot for a second"},
});

inline constexpr auto kSlipReasonNames = std::to_array<BitName>({
    {kSlipSpinning, "spinning", "the wheels turn faster than the ground passes", "reduce the acceleration"},
    {kSlipStalled, "stalled", "the wheels turn slower than the ground passes", "reduce the deceleration"},
    {kSlipBlocked, "blocked", "the wheels turn, but the robot stands", "remove what blocks the robot"},
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
