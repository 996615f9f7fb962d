#include "ros/reports/diagnostics.h"

#include <algorithm>
#include <numbers>

#include "files/ascii.h"
#include "machine/fault_names.h"
#include "ros/reports/name_list.h"
#include "signals/formatted_text.h"
#include "signals/names.h"
#include "signals/wheeled/slip_detection.h"

namespace robot_control {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;  // ° per rad

}  // namespace

DiagnosticReport::DiagnosticReport(const std::string& node, const std::string& hardware) {
  message_.level = diagnostic_msgs::DiagnosticStatus::OK;
  message_.name = node;
  message_.hardware_id = hardware;
}

void DiagnosticReport::value(const std::string& key, const std::string& text) {
  diagnostic_msgs::KeyValue pair;
  pair.key = key;
  pair.value = ascii(text);
  message_.values.push_back(pair);
}

void DiagnosticReport::value(const std::string& key, double number) {
  value(key, formatted("%.6g", number));
}

void DiagnosticReport::reasons(const std::string& subject, std::span<const BitName> table, std::uint64_t bits,
                               const Programs& programs) {
  for (const BitName& row : table) {
    if ((bits & row.bit) == 0) continue;
    value(subject + ": " + std::string(row.name), with_programs(row.sentence, programs));
    if (!row.remedy.empty()) value(subject + " remedy: " + std::string(row.name), with_programs(row.remedy, programs));
  }
}

void DiagnosticReport::raise(diagnostic_msgs::DiagnosticStatus::_level_type level, const std::string& sentence) {
  if (level < message_.level) return;
  if (level > message_.level) message_.message.clear();
  message_.level = level;
  if (!message_.message.empty()) message_.message += "; ";
  message_.message += ascii(sentence);
}

void report_missing(DiagnosticReport& report, const std::vector<std::string>& missing) {
  const std::string names = joined(missing);
  if (!names.empty()) report.warn("waiting for " + names);
  report.value("waiting_for", names);
}

void report_driver(DiagnosticReport& report, const SensorFrame& sensors, const MachineModel& machine,
                   const Programs& programs, double real_time_factor) {
  if (sensors.driver_state == DriverState::kFault)
    report.error(sentences_of(kDriverFaultNames, sensors.faults, programs));
  if (sensors.driver_state == DriverState::kPaused) report.ok("paused");
  const std::string injected = names_of(sensors.injected, machine);
  if (any_fault(sensors.injected)) report.warn("injected faults: " + injected);
  for (std::size_t i = 0; i < std::min<std::size_t>(sensors.link_count, kMaxLinks); ++i) {
    const LinkStatus& link = sensors.links[i];
    const std::string name = "link_" + std::to_string(i);
    const std::string state(name_of(link.state));
    if (link.state != LinkState::kUp) report.warn(name + " is " + state);
    report.value(name, state);
    report.value(name + "_sent", link.sent);
    report.value(name + "_lost", link.lost);
    report.value(name + "_late", link.late);
    report.value(name + "_errors", link.errors);
  }
  report.value("driver_state", std::string(name_of(sensors.driver_state)));
  report.value("faults", names_of(kDriverFaultNames, sensors.faults));
  report.value("cycle", sensors.head.cycle);
  report.value("real_time_factor", real_time_factor);
  report.value("overruns", sensors.overruns);
  report.value("slipped_s", static_cast<double>(sensors.slipped_ns) * 1.0e-9);
  report.value("held_s", static_cast<double>(sensors.held_ns) * 1.0e-9);
  report.value("injected", injected);
  report.value("gate_verdict", std::string(name_of(sensors.gate.verdict)));
  report.value("gate_reasons", names_of(kGateReasonNames, sensors.gate.reasons));
  report.value("commands_held", sensors.gate.held);
  report.value("commands_missed", sensors.gate.missed);
  report.value("permits_late", sensors.gate.late_permits);
  report.value("frames_refused", sensors.gate.refused);
  report.reasons("gate", kGateReasonNames, sensors.gate.reasons, programs);
}

void report_state(DiagnosticReport& report, const StateFrame& state, std::uint64_t slip_lately,
                  const Programs& programs) {
  constexpr std::uint64_t kLost = kStateNoGyro | kStateNoAccelerometer | kStateNoLeftEncoder | kStateNoRightEncoder;
  if ((state.base.flags & kStateValid) == 0) report.warn("pose and twist are not valid");
  if (state.head.run == 0) return;  // There is no state yet; a deviation of zero would say that its value is known.
  if ((state.base.flags & kLost) != 0) report.warn(sentences_of(kStateFlagNames, state.base.flags & kLost, programs));
  if ((slip_lately | state.wheeled.slip) != 0) {
    report.warn("slip: " + sentences_of(kSlipReasonNames, slip_lately | state.wheeled.slip, programs));
  } else if ((state.base.flags & kStateSlip) != 0) {
    report.warn("slip: wheels and inertial sensors disagree");
  }
  if ((state.base.flags & kStateDegraded) != 0)
    report.warn("odometry is degraded: " + sentences_of(kDegradedReasonNames, state.base.degraded, programs));
  report.value("cycle", state.head.cycle);
  report.value("flags", names_of(kStateFlagNames, state.base.flags));
  report.value("degraded", names_of(kDegradedReasonNames, state.base.degraded));
  report.value("distance_m", state.base.distance);
  report.value("skipped", state.skipped);
  report.value("slip", names_of(kSlipReasonNames, state.wheeled.slip));
  report.value("slip_lately", names_of(kSlipReasonNames, slip_lately));
  report.reasons("slip", kSlipReasonNames, slip_lately | state.wheeled.slip, programs);
  report.reasons("estimate", kStateFlagNames, state.base.flags & kLost, programs);
  report.reasons("degraded", kDegradedReasonNames, state.base.degraded, programs);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("gyro_bias_") + "xyz"[axis];
    report.value(name + "_deg_s", state.base.gyro_bias[axis] * kDegrees);
    report.value(name + "_deviation_deg_s", state.base.gyro_bias_deviation[axis] * kDegrees);
  }
  if (programs.kind != kWheeledKind) return;
  report.value("residual_level", state.wheeled.residual_level);
  report.value("slip_detection", slip_detection(state.wheeled.residual_level));
  for (std::size_t i = 0; i < kStateSensorNames.size(); ++i) {
    const std::string sensor(kStateSensorNames[i]);
    report.value("confidence_" + sensor, state.wheeled.confidence[i]);
    report.value("nis_" + sensor, state.wheeled.nis[i]);
    report.value("rejected_" + sensor, state.wheeled.rejected[i]);
  }
  // The pose is made of the encoders of both sides and of the gyro; the accelerometer only serves to notice slip.
  report.value("odometry_confidence", std::ranges::min(std::span(state.wheeled.confidence).first<kAccelerometer>()));
  report.value("radius_ratio", state.wheeled.calibration.radius_ratio);
  report.value("radius_ratio_deviation", state.wheeled.calibration.radius_ratio_deviation);
  report.value("wheel_base_factor", state.wheeled.calibration.wheel_base_factor);
  report.value("wheel_base_deviation", state.wheeled.calibration.wheel_base_deviation);
}

void report_command(DiagnosticReport& report, const CommandFrame& command, std::uint64_t lately,
                    const Programs& programs, const std::vector<std::string>& senders,
                    const std::vector<std::string>& sources, const std::vector<std::string>& revoked) {
  constexpr std::uint64_t kRefusals =
      kReasonRefused | kReasonStale | kReasonManySenders | kReasonRevoked | kReasonPartIgnored;
  if ((lately & kRefusals) != 0) report.warn(sentences_of(kCommandReasonNames, lately & kRefusals, programs));
  if (senders.size() > 1 && sources.empty()) report.warn("commands come from more than one node: " + joined(senders));
  report.value("cycle", command.head.cycle);
  report.value("reasons", names_of(kCommandReasonNames, command.reasons));
  report.value("reasons_lately", names_of(kCommandReasonNames, lately));
  report.value("senders", joined(senders));
  if (!sources.empty()) report.value("sources", joined(sources));
  report.value("revoked_senders", joined(revoked));
  report.value("commands_received", command.requests_received);
  report.value("commands_refused", command.requests_refused);
  report.value("commands_stale", command.requests_stale);
  report.value("commands_of_too_many_senders", command.requests_crowded);
  report.value("commands_of_revoked_senders", command.requests_revoked);
  report.value("commands_partly_ignored", command.requests_partial);
  report.value("ignored", names_of(kRequestPartNames, command.ignored));
  report.value("timeouts", command.timeouts);
  report.value("requested_m_s", command.requested.twist.linear[0]);
  report.value("requested_rad_s", command.requested.twist.angular[2]);
  report.reasons("command", kCommandReasonNames, command.reasons, programs);
}

void report_permit(DiagnosticReport& report, const Permit& permit, const Programs& programs) {
  if (permit.causes != 0)
    report.error(sentences_of(kStopCauseNames, permit.causes, programs) + "; then call e_stop_reset");
  if (permit.warnings != 0) report.warn(sentences_of(kStopCauseNames, permit.warnings, programs));
  report.value("cycle", permit.head.cycle);
  report.value("state", std::string(name_of(permit.state)));
  report.value("permit", std::string(name_of(permit.action)));
  report.value("causes", names_of(kStopCauseNames, permit.causes));
  report.value("active", names_of(kStopCauseNames, permit.active));
  report.value("warnings", names_of(kStopCauseNames, permit.warnings));
  if (permit.speed_limit < kNoSpeedLimit) report.value("speed_limit_m_s", permit.speed_limit);
}

}  // namespace robot_control
